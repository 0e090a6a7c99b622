# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Volumes of cells of which only the places are known: their Voronoi regions, cut off outside."""
import numpy as np
from scipy import ndimage, spatial

from morula.refusal import Refused

REACH = 1.75  # spacings: regions and concave parts of the tissue are bounded so far from places
VOXELS = 5e5
SHARES = np.linspace(0.2, 0.65, 10)  # of a spacing, by which the hull may lie outside of places


def clipped_volumes(places):
    """Volumes (n) of cells at places (n, dim), and how far outside of them the tissue ends.

    Voxels belong to the nearest place. The tissue ends at planes parallel to those of the convex
    hull, and in concave parts where a ball of radius REACH does not get between the places. The
    distance is that at which the outer cells have their places in the middle of their regions,
    about half a spacing; the spacing follows from the volume, so all is done a few times."""
    n, dim = places.shape
    tree, hull = spatial.cKDTree(places), spatial.ConvexHull(places, qhull_options="QJ").equations
    outward = hull[(places @ hull[:, :-1].T + hull[:, -1]).argmax(1), :-1]
    spacing = 1.3 * np.median(tree.query(places, 2)[0][:, 1])
    for _ in range(4):
        reach = REACH * spacing
        low, high = places.min(0) - reach - spacing, places.max(0) + reach + spacing
        edge = max(spacing / 8, ((high - low).prod() / VOXELS) ** (1 / dim))
        grid = np.stack(np.meshgrid(*[np.arange(a, b, edge) for a, b in zip(low, high)],
                                    indexing="ij"), -1)
        distance, owner = tree.query(grid, distance_upper_bound=reach)
        near = np.isfinite(distance)
        level = (reach - edge * ndimage.distance_transform_edt(near))[near]
        grid, owner = grid[near], owner[near]
        rim, beyond = level > 0, np.full(len(level), -np.inf)
        for plane in hull:
            beyond[rim] = np.maximum(beyond[rim], grid[rim] @ plane[:-1] + plane[-1])
        level = np.where(beyond > 0, beyond, level)
        offsets = []
        for distance in SHARES * spacing:
            inside = level < distance
            count = np.bincount(owner[inside], minlength=n)
            middle = np.stack([np.bincount(owner[inside], grid[inside, k], n)
                               for k in range(dim)], 1) / np.maximum(count, 1)[:, None]
            outer = np.bincount(owner[inside & (beyond > distance - 0.4 * spacing)],
                                minlength=n) > 0
            offsets.append(((middle - places) * outward).sum(1)[outer].mean())
        distance = np.interp(0, offsets, SHARES * spacing)
        volumes = np.bincount(owner[level < distance], minlength=n) * edge**dim
        before, spacing = spacing, (volumes.sum() / n) ** (1 / dim)
        if abs(spacing / before - 1) < 0.005:
            break
    return volumes, distance


def volumes_within(places, file):
    """Volumes (n) of the regions of cells at places (n, dim) in a closed surface. Throws Refused."""
    from .surface import contains, read_parts
    n, parts = len(places), read_parts(file, places.shape[1])
    corners = np.concatenate([part.vertices for part in parts])
    low, size = corners.min(0), np.ptp(corners, axis=0)
    counts = np.ceil(size * (VOXELS / size.prod()) ** (1 / len(size))).astype(int)
    grid = np.concatenate([places, low + (np.argwhere(np.ones(counts)) + 0.5) * size / counts])
    inside = np.logical_xor.reduce([contains(part, grid) for part in parts])
    if not inside[:n].all():
        raise Refused("--surface", file, "a closed surface around the cells, in um",
                      f"{(~inside[:n]).sum()} of {n} places are outside.")
    owner = spatial.cKDTree(places).query(grid[inside])[1]  # the first are the places themselves
    return (np.bincount(owner) - 1) * (size / counts).prod()
