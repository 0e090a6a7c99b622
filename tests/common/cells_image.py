# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A label image of a hollow ball of cells (2-D: of a ring), made for tests."""
import numpy as np
from scipy.spatial import cKDTree

OUTER, INNER, EDGE = 40.0, 20.0, 96.0  # um
VOXEL = np.array([2.0, 0.5, 0.5])  # um, z, y, x


def hollow_ball(dim=3, coarse=1, torn=True, seed=1):
    """Labels and the edges of a voxel (um), both in the order z, y, x. Labels
    touch, are not consecutive, and fill what is between two spheres around the
    image's middle; one is torn into two pieces by a slit of 3 um."""
    rng = np.random.default_rng(seed)
    voxel = coarse * VOXEL[-dim:]
    axes = [np.arange(edge / 2, EDGE, edge) - EDGE / 2 for edge in voxel]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    radius = np.linalg.norm(places, axis=-1)
    centres = []
    apart = 9.0 if dim == 3 else 8.0
    for _ in range(20000):
        place = rng.uniform(-OUTER, OUTER, dim)
        if INNER < np.linalg.norm(place) < OUTER and all(
                np.linalg.norm(place - other) > apart for other in centres):
            centres.append(place)
        if len(centres) == (150 if dim == 3 else 34):
            break
    labels = 3 * cKDTree(centres).query(places)[1] + 10
    labels[(radius > OUTER) | (radius < INNER)] = 0
    if torn:
        label = np.unique(labels)[5]
        middle = places[labels == label][:, -1].mean()
        labels[(labels == label)
               & (np.abs(places[..., -1] - middle) < 1.5)] = 0
    return labels.astype(np.uint16), voxel
