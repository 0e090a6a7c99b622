# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Many convex polyhedra in a few arrays."""
from dataclasses import dataclass

import numpy as np

# What is beyond a face, where it is not another cell.
SURFACE = -1  # the outside of the tissue
FLAT = -2     # bottom and top of a prism, that is of a region in 2-D
FAR = -3      # nothing: one of the points far away that bound all regions


def ranges(starts, counts):
    """All of start, start + 1, ... start + count - 1, one after the other."""
    ends = np.cumsum(counts)
    return (np.arange(ends[-1] if len(ends) else 0) + np.repeat(starts - (ends - counts), counts))


@dataclass(frozen=True)
class Polyhedra:
    """Faces of polyhedra. Face f has the corners[starts[f]:starts[f + 1]], rows of `points` (um),
    in a circle and counterclockwise from outside; it belongs to the polyhedron `owner[f]`, and
    `beyond[f]` is the cell on its other side, or SURFACE, FLAT, FAR."""

    points: np.ndarray   # (n, 3), um
    corners: np.ndarray
    starts: np.ndarray   # one more than faces
    owner: np.ndarray
    beyond: np.ndarray

    @property
    def counts(self):
        """Corners of each face."""
        return np.diff(self.starts)

    def following(self):
        """For each entry of `corners`, the entry next to it in its face."""
        result = np.arange(1, len(self.corners) + 1)
        result[self.starts[1:] - 1] = self.starts[:-1]
        return result

    def select(self, faces):
        """The polyhedra of these faces alone, a mask or numbers."""
        faces = np.arange(len(self.owner))[faces]
        counts = self.counts[faces]
        return Polyhedra(self.points, self.corners[ranges(self.starts[faces], counts)],
                         np.concatenate([[0], np.cumsum(counts)]), self.owner[faces],
                         self.beyond[faces])

    def turned(self, which):
        """With the faces of this mask the other way round."""
        counts = self.counts
        place = np.arange(len(self.corners))
        mirror = np.repeat(self.starts[:-1] + self.starts[1:] - 1, counts) - place
        corners = self.corners[np.where(np.repeat(which, counts), mirror, place)]
        return Polyhedra(self.points, corners, self.starts, self.owner, self.beyond)

    def area_vectors(self):
        """Area (um^2) times outward unit normal of each face."""
        first = np.repeat(self.points[self.corners[self.starts[:-1]]], self.counts, axis=0)
        arms = self.points[self.corners] - first
        return 0.5 * np.add.reduceat(np.cross(arms, arms[self.following()]), self.starts[:-1])

    def volumes(self, centres):
        """Volumes (um^3) of the polyhedra round the centres (n, 3), which
        may be any points: that of a cone for each face."""
        corner = self.points[self.corners[self.starts[:-1]]]
        cones = np.einsum("ij,ij->i", corner - centres[self.owner], self.area_vectors()) / 3
        return np.bincount(self.owner, cones, len(centres))


def joined(parts):
    """All faces of several Polyhedra that share the points of the last one:
    each has the points of those before it, and more."""
    parts = [part for part in parts if len(part.owner)]
    counts = np.concatenate([part.counts for part in parts])
    return Polyhedra(parts[-1].points,
                     np.concatenate([part.corners for part in parts]),
                     np.concatenate([[0], np.cumsum(counts)]),
                     np.concatenate([part.owner for part in parts]),
                     np.concatenate([part.beyond for part in parts]))
