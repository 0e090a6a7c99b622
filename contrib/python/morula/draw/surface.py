# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The surface through a run's boundary points."""
import numpy as np
from scipy.spatial import ConvexHull


def triangles_of(initial_positions):
    """Triangles (n, 3), outward, of points on a convex body's surface.

    Boundary points are neither lost nor made, so that the triangles of their initial positions are
    those of the deformed surface as well. On a flat face all of the hull's points are corners of
    triangles, too: the points are pushed outward a little, the middle most, which makes them
    strictly convex."""
    center = (initial_positions.min(axis=0) + initial_positions.max(axis=0)) / 2
    offset = initial_positions - center
    size = np.abs(offset).max()
    bulged = offset * (1 + 1e-3 * (1 - (offset / size)**2).sum(axis=1, keepdims=True))
    triangles = ConvexHull(bulged).simplices
    a, b, c = (bulged[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) < 0
    triangles[inward] = triangles[inward][:, [0, 2, 1]]
    return triangles
