# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The Voronoi regions of all cells, bounded by points far away."""
from itertools import chain

import numpy as np
from scipy.spatial import Voronoi

from .polyhedra import FAR, FLAT, Polyhedra, joined

DISTANCE = 10  # of the points far away, in sizes of the tissue


def voronoi_regions(positions, length, flat):
    """The regions of cells at positions (n, 3), um, of at most this length;
    flat ones, with z = 0, as prisms from z = -1/2 to z = 1/2."""
    dim = 2 if flat else 3
    diagram = Voronoi(np.vstack([positions[:, :dim], far_points(positions[:, :dim], length)]))
    walls, pairs = walls_of(diagram, dim)
    cells = len(positions)
    # Each wall is a face of the regions on both of its sides.
    sides = Polyhedra(walls.points, np.tile(walls.corners, 2),
                      np.concatenate([walls.starts, walls.starts[1:]
                                      + walls.starts[-1]]),
                      pairs.T.ravel(), pairs[:, ::-1].T.ravel())
    sides = sides.select(sides.owner < cells)
    to_other = (diagram.points[sides.beyond] - diagram.points[sides.owner]) @ np.eye(dim, 3)
    inward = np.einsum("ij,ij->i", sides.area_vectors(), to_other) < 0
    sides = sides.turned(inward)
    sides.beyond[sides.beyond >= cells] = FAR
    return joined([sides, *ends_of(sides, positions)]) if flat else sides


def far_points(positions, length):
    """Points around the tissue, so far away that they bound the regions of
    its outermost cells without taking part otherwise."""
    low, high = positions.min(axis=0), positions.max(axis=0)
    size = DISTANCE * max(length, (high - low).max())
    steps = np.stack(np.meshgrid(*[[-1, 0, 1]] * positions.shape[1]),
                     axis=-1).reshape(-1, positions.shape[1])
    return (low + high) / 2 + size * steps[np.any(steps != 0, axis=1)]


def walls_of(diagram, dim):
    """The diagram's walls as faces, those of prisms in 2-D, and the two points
    that each one lies between."""
    counts = np.fromiter(map(len, diagram.ridge_vertices), dtype=np.int64,
                         count=len(diagram.ridge_vertices))
    corners = np.fromiter(chain.from_iterable(diagram.ridge_vertices),
                          dtype=np.int64, count=counts.sum())
    starts = np.concatenate([[0], np.cumsum(counts)])
    # A wall of less corners has no area; -1 is infinitely far, between two of
    # the points far away.
    kept = (counts >= dim) & (np.minimum.reduceat(corners, starts[:-1]) >= 0)
    points = diagram.vertices
    if dim == 2:
        number, corners = len(points), corners.reshape(-1, 2)
        corners = np.hstack([corners, corners[:, ::-1] + number]).ravel()
        starts = 2 * starts
        points = np.vstack([np.insert(points, 2, z, axis=1) for z in (-0.5, 0.5)])
    nobody = np.zeros(len(counts), dtype=np.int64)
    walls = Polyhedra(points, corners, starts, nobody, nobody).select(kept)
    return walls, diagram.ridge_points[kept].astype(np.int64)


def ends_of(sides, positions):
    """Bottom and top of the prisms with these sides."""
    number = len(sides.points) // 2
    corners = sides.corners.reshape(-1, 4)
    below = corners < number
    # Seen from outside, a side's corners at the bottom go round its cell
    # counterclockwise, too; the first of each is the polygon's corner.
    first = below & ~np.roll(below, 1, axis=1)
    corners = corners[first]
    offset = sides.points[corners] - positions[sides.owner]
    order = np.lexsort([np.arctan2(offset[:, 1], offset[:, 0]), sides.owner])
    owner, counts = np.unique(sides.owner, return_counts=True)
    top = Polyhedra(sides.points, corners[order] + number, np.concatenate([[0], np.cumsum(counts)]),
                    owner, np.full(len(owner), FLAT))
    bottom = Polyhedra(top.points, top.corners - number, top.starts, owner, top.beyond)
    return bottom.turned(np.ones(len(owner), dtype=bool)), top
