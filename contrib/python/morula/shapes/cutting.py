# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A plane through each of many convex polyhedra at once."""
import numpy as np

from .polyhedra import Polyhedra, joined, ranges

ON_PLANE = 1e-9  # um: a corner this near to a plane lies on it


def cut(bodies, origin, normal, beyond):
    """What remains of each polyhedron on the inner side of its plane, which
    goes through `origin`, with outward unit `normal`, both (n, 3) for owners 0
    to n - 1. `beyond` (n) says what is on the other side of the new faces."""
    owner = np.repeat(bodies.owner, bodies.counts)  # of each corner
    height = np.einsum("ij,ij->i", bodies.points[bodies.corners] - origin[owner], normal[owner])
    height[np.abs(height) <= ON_PLANE] = 0
    sides, rims = cut_faces(bodies, owner, height)
    return joined([sides, lids(sides.points, *rims, normal, beyond)])


def cut_faces(bodies, owner, height):
    """The faces that there were, cut off, with the new points; and the owners
    and points of the rims: corners of what remains that lie on the planes."""
    following = bodies.following()
    corners, next_height = bodies.corners, height[following]
    crossing = height * next_height < 0
    new, of_edge = crossings(bodies, owner, height, crossing)
    points = np.vstack([bodies.points, new])

    # Round each face: a corner if it stays, then the point where the edge to
    # the next one goes through the plane.
    there = np.stack([height <= 0, crossing], axis=1)
    number = np.zeros((len(corners), 2), dtype=np.int64)
    number[:, 0] = corners
    number[crossing, 1] = len(bodies.points) + of_edge
    counts = np.add.reduceat(there.sum(axis=1), bodies.starts[:-1])
    # Nothing is left of a face that touches its plane with an edge.
    low = np.minimum.reduceat(height, bodies.starts[:-1])
    kept = (counts >= 3) & (low < 0)
    there &= np.repeat(kept, bodies.counts)[:, None]
    sides = Polyhedra(points, number[there], np.concatenate([[0], np.cumsum(counts[kept])]),
                      bodies.owner[kept], bodies.beyond[kept])
    on_plane = there & np.stack([height == 0, crossing], axis=1)
    rim = np.unique(np.stack([np.repeat(owner, 2)[on_plane.ravel()],
                              number[on_plane]], axis=1), axis=0)
    return sides, (rim[:, 0], rim[:, 1])


def crossings(bodies, owner, height, crossing):
    """Where edges go through planes: the points (n, 3), and which of them lies
    on each crossing edge, equal for the two faces of the edge."""
    here, there = np.flatnonzero(crossing), bodies.following()[crossing]
    swapped = bodies.corners[here] > bodies.corners[there]
    here, there = (np.where(swapped, there, here), np.where(swapped, here, there))
    edge = np.stack([owner[here], bodies.corners[here], bodies.corners[there]], axis=1)
    _, index, of_edge = np.unique(edge, axis=0, return_index=True, return_inverse=True)
    here, there = here[index], there[index]
    part = (height[here] / (height[here] - height[there]))[:, None]
    return ((1 - part) * bodies.points[bodies.corners[here]]
            + part * bodies.points[bodies.corners[there]]), of_edge


def lids(points, owner, rim, normal, beyond):
    """The faces on the planes: their corners in a circle round the middle."""
    owners, counts = np.unique(owner, return_counts=True)
    kept = counts >= 3
    starts = np.cumsum(counts) - counts
    middle = np.add.reduceat(points[rim], starts) / counts[:, None]
    arms = points[rim] - np.repeat(middle, counts, axis=0)
    along = normal[owners]
    # Two axes in each plane, right-handed with the normal.
    other = np.eye(3)[np.abs(along).argmin(axis=1)]
    first = np.cross(other, along)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(along, first)
    angle = np.arctan2(np.einsum("ij,ij->i", arms, np.repeat(second, counts, axis=0)),
                       np.einsum("ij,ij->i", arms, np.repeat(first, counts, axis=0)))
    rim = rim[np.lexsort([angle, owner])]
    rim = rim[ranges(starts[kept], counts[kept])]
    return Polyhedra(points, rim, np.concatenate([[0], np.cumsum(counts[kept])]), owners[kept],
                     beyond[owners[kept]])
