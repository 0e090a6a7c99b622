# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The outline of a cut: where the plane of the cut goes through the tissue's surface."""
import numpy as np
from scipy.ndimage import gaussian_filter, zoom
from scipy.spatial import cKDTree

from morula.shapes.boundary import Boundary

FINE = 400     # pixels across that are asked
STEEP = 0.15   # least cosine between the view and the plane's normal
NEAR = 1.2     # in lengths of a cell: farther from every cell is a cavity
SMOOTH = 1.2   # pixels of these


def inside_of_cut(positions, length, surface, plane, view, pixels, bodies=None):
    """For each pixel (height, width), 1 where the plane (a point, its unit normal) is within the
    tissue, with a smooth edge at 0.5. positions (n, 3) are those of the cells, of this length;
    surface: places and outward normals of the boundary points; all in µm. bodies: numbers of the
    bodies of cells and of boundary points, where there are some: the tissue is all of them. None
    where the plane is seen from its edge."""
    origin, normal = plane
    toward = view.direction / np.linalg.norm(view.direction)
    if abs(toward @ normal) < STEEP or not len(surface[0]):
        return None
    width = min(FINE, pixels[0])
    height = max(2, round(width * pixels[1] / pixels[0]))
    over = np.cross(toward, view.right)
    across = view.half_width * (2 * (np.arange(width) + 0.5) / width - 1)
    up = view.half_height * (1 - 2 * (np.arange(height) + 0.5) / height)
    places = (view.center + across[None, :, None] * view.right
              + up[:, None, None] * over).reshape(-1, 3)
    places = places + ((origin - places) @ normal / (toward @ normal))[:, None] * (toward)
    of_cells, of_points = bodies or (np.zeros(len(positions)), np.zeros(len(surface[0])))
    inside = np.zeros(len(places), dtype=bool)
    for body in np.intersect1d(of_cells, of_points):
        near, _ = cKDTree(positions[of_cells == body]).query(
            places, distance_upper_bound=NEAR * length)
        held = np.isfinite(near)
        held[held] = ~Boundary(*(part[of_points == body] for part in surface)
                               ).outside(places[held], 0.0)
        inside |= held
    mask = gaussian_filter(inside.reshape(height, width).astype(float), SMOOTH)
    return zoom(mask, (pixels[1] / height, pixels[0] / width), order=1,
                grid_mode=True, mode="nearest")
