# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The tissue's surface, a cloud of boundary points, and which of their tangent planes cut which
region.

A place is outside the tissue if it is beyond the tangent plane of the boundary point nearest to
it. So a region is cut by the plane of the boundary point nearest to its cell, then by that of the
boundary point nearest to the corner that is farthest outside, and so on until no corner is
outside. Planes of boundary points farther away, which would cut off what lies round a concave
surface, do not come into it."""
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from .cutting import cut
from .polyhedra import FAR, FLAT, SURFACE, joined

# In lengths of a cell, the cube root of its volume:
OUTSIDE = 1e-3  # corners less far outside are not cut off
INSIDE = 0.05   # so far inside of its planes a cell is whose region is raised
RAISED = 0.5    # half the edge of the cube that it stays in
BEYOND = 0.5    # so far outside of its own part of the surface a cell may be
ASTRAY = 2.0    # ... and beyond other planes of that part, so much farther

SAME_SIDE = 0.5   # least cosine between normals of one part of the surface
LEAST = 0.05      # of a cell's volume: a smaller region is raised
NEAR = 8          # boundary points that are looked at, nearest first
MOST_PLANES = 50  # through a region


class Boundary:
    """The boundary points, positions (n, 3) in um, and normals, outward."""

    def __init__(self, positions, normals):
        self.positions, self.normals = positions, normals
        self.tree = cKDTree(positions)

    def nearest(self, places):
        """Number of the boundary point nearest to each place (n, 3)."""
        return self.tree.query(places)[1]

    def near(self, places):
        """The boundary points nearest to each place, nearest first."""
        number = min(NEAR, len(self.positions))
        return self.tree.query(places, number)[1].reshape(-1, number)

    def height(self, points, places):
        """How far (um) places are outside of the planes of boundary points."""
        return np.einsum("ij,ij->i", places - self.positions[points], self.normals[points])

    def outside(self, places, distance):
        """Whether places are more than a distance (um) outside."""
        return self.height(self.nearest(places), places) > distance


class Planes:
    """The planes that may cut the regions of some cells, numbered from 0."""

    def __init__(self, boundary, centres, lengths, raised=False):
        self.boundary, self.raised = boundary, raised
        self.centres, self.lengths = centres, lengths  # um
        self.own, own_height = self._own_points()
        # How far (um) a cell may be outside of planes of its own part of the
        # surface. A daughter can be put outside.
        self.slack = np.maximum(0, own_height) + ASTRAY * lengths
        self.astray = own_height > ASTRAY * lengths

    def _own_points(self):
        """For each cell, the nearest boundary point that does not have it far outside, or else the
        nearest of all; and how far (um) it is outside of that one's plane."""
        near = self.boundary.near(self.centres)
        height = self.boundary.height(near.ravel(), np.repeat(self.centres, near.shape[1], axis=0))
        height = height.reshape(near.shape)
        first = (height <= BEYOND * self.lengths[:, None]).argmax(axis=1)
        rows = np.arange(len(near))
        return near[rows, first], height[rows, first]

    def first_points(self):
        """For every cell the boundary point whose plane is to cut first; -1
        for a cell that no part of the surface can be told for."""
        return np.where(self.astray, -1, self.own)

    def shift(self, cells, points):
        """How far (um) the planes of boundary points move outward for cells
        whose regions are raised: so far that the cells are inside."""
        if not self.raised:
            return np.zeros(len(points))
        height = self.boundary.height(points, self.centres[cells])
        return np.maximum(0, height + INSIDE * self.lengths[cells])

    def allowed(self, cells, points):
        """Whether planes of boundary points may cut cells: those that have the
        cell inside, and those of the cell's own part of the surface."""
        normals = self.boundary.normals
        same_side = np.einsum("ij,ij->i", normals[points], normals[self.own[cells]]) > SAME_SIDE
        slack = np.where(same_side & ~self.astray[cells], self.slack[cells], 0)
        return self.boundary.height(points, self.centres[cells]) <= slack

    def cut(self, bodies, points):
        """The regions, cut by the plane of one boundary point each; of -1 by
        none. `points` has an entry for every cell."""
        cut_now = points[bodies.owner] >= 0
        if not cut_now.any():
            return bodies
        shift = self.shift(np.arange(len(points)), points)
        normal = self.boundary.normals[points]
        origin = self.boundary.positions[points] + shift[:, None] * normal
        changed = cut(bodies.select(cut_now), origin, normal, np.full(len(points), SURFACE))
        rest = bodies.select(~cut_now)
        return joined([rest, changed])

    def other_points(self, cells, places):
        """For places that are outside of the surface of another part, across
        a gap: the nearest boundary points that may cut, if there are such."""
        near = self.boundary.near(places)
        shape = near.shape
        allowed = self.allowed(np.repeat(cells, shape[1]), near.ravel())
        first = allowed.reshape(shape).argmax(axis=1)
        return near[np.arange(len(near)), first]

    def next_points(self, bodies):
        """For every cell the boundary point whose plane is to cut its region
        next, that of the corner farthest outside; -1 if none is outside."""
        owner = np.repeat(bodies.owner, bodies.counts)
        pairs = np.unique(owner * len(bodies.points) + bodies.corners)
        owner, corner = np.divmod(pairs, len(bodies.points))
        places = bodies.points[corner]
        points = self.boundary.nearest(places)
        height = (self.boundary.height(points, places) - self.shift(owner, points))
        outside = height > OUTSIDE * self.lengths[owner]
        owner, places, points = owner[outside], places[outside], points[outside]
        allowed = self.allowed(owner, points)
        points[~allowed] = self.other_points(owner[~allowed], places[~allowed])
        height = (self.boundary.height(points, places) - self.shift(owner, points))
        cuts = ((height > OUTSIDE * self.lengths[owner]) & self.allowed(owner, points))
        owner, points, height = owner[cuts], points[cuts], height[cuts]
        order = np.lexsort([height, owner])
        chosen = np.full(len(self.own), -1)
        chosen[owner[order]] = points[order]  # the last of each cell
        return chosen


def cut_at_surface(bodies, boundary, centres, lengths, volumes):
    """The regions of cells at the centres (n, 3), cut off at the surface;
    lengths and volumes (n), um, are those of the cells.

    A cell outside of the surface keeps what its region has inside. Where that
    is next to nothing, the region is raised: planes move outward until the
    cell is inside, but it does not reach farther than a cell does."""
    result = cut_by_planes(bodies, Planes(boundary, centres, lengths))
    low = result.volumes(centres) < LEAST * volumes
    if low.any():
        again = replace(bodies.select(low[bodies.owner]), points=result.points)
        again = cut_by_planes(again, Planes(boundary, centres, lengths, raised=True))
        again = cut_to_cube(again, centres, RAISED * lengths)
        result = joined([result.select(~low[result.owner]), again])
    # Cells that are lost far outside have no surface near them.
    lost = np.zeros(len(centres), dtype=bool)
    lost[result.owner[result.beyond == FAR]] = True
    if lost.any():
        again = cut_to_cube(result.select(lost[result.owner]), centres, lengths)
        result = joined([result.select(~lost[result.owner]), again])
    return result


def cut_by_planes(bodies, planes):
    """Until no corner is outside that a plane may cut off."""
    finished, points = [], planes.first_points()
    for _ in range(MOST_PLANES):
        bodies = planes.cut(bodies, points)
        points = planes.next_points(bodies)
        more = points[bodies.owner] >= 0
        finished.append(bodies.select(~more))
        bodies = bodies.select(more)
        if not len(bodies.owner):
            break
    return joined([*finished, bodies])


def cut_to_cube(bodies, centres, half_edges):
    """What is in the cubes round the cells (2-D: squares)."""
    dim = 2 if np.any(bodies.beyond == FLAT) else 3
    for direction in np.vstack([np.eye(dim, 3), -np.eye(dim, 3)]):
        normal = np.tile(direction, (len(centres), 1))
        bodies = cut(bodies, centres + half_edges[:, None] * normal, normal,
                     np.full(len(centres), SURFACE))
    return bodies
