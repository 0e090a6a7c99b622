# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Outlines of the half-fixed sphere, and how far they are apart."""
from dataclasses import dataclass

import numpy as np

# Free points that began so low (µm) count as near the clamp: twice the
# coarsest spacing of the grids that the paper finds good enough.
NEAR_CLAMP = 100.0


def surface_of(run, time):
    """Initial and current positions (n, 3) of the boundary points, and which
    are free."""
    positions, columns = run.read("surface", time)
    initial = np.stack([columns[name] for name in "XYZ"], axis=1)
    return initial, positions, columns["condition"] == 0


def profile(run, time, points=800):
    """The outline (r, z) in µm of a body of revolution, from bottom to top:
    the mean over the azimuth as a function of the initial polar angle.

    Each initial latitude holds one boundary point, so that a local line
    through its neighbours, weighted by (1 - d³)³ of their angular distance,
    gives the mean; held and free points are not mixed.
    """
    initial, positions, free = surface_of(run, time)
    angle = np.arccos(initial[:, 2] / np.linalg.norm(initial, axis=1))
    r = np.linalg.norm(positions[:, :2], axis=1)
    z = positions[:, 2]
    parts = [smooth(angle[part], r[part], z[part], points // 2)
             for part in (~free, free) if part.any()]
    r, z = (np.concatenate(values) for values in zip(*parts))
    # The last points are half a patch away from the axis.
    return np.pad(r, 1), np.pad(z, 1, mode="edge")


def smooth(angle, r, z, points):
    """Local weighted lines through r and z at evenly spaced angles, from the
    largest to the smallest."""
    width = 0.04  # rad, or as much as holds a dozen points
    fewest = min(11, len(angle) - 1)
    places = np.linspace(angle.max(), angle.min(), points)
    found = []
    for place in places:
        distance = np.abs(angle - place)
        reach = max(width, 1.01 * np.partition(distance, fewest)[fewest])
        weight = np.clip(1 - (distance / reach)**3, 0, None)**3
        matrix = np.stack([np.ones_like(angle), angle - place], axis=1)
        root = np.sqrt(weight)[:, None]
        solution, *_ = np.linalg.lstsq(
            root * matrix, root * np.stack([r, z], axis=1), rcond=None)
        found.append(solution[0])
    return tuple(np.array(found).T)


@dataclass(frozen=True)
class Distance:
    """Of a free surface from an outline, µm: root mean squares and maxima near
    the clamp and away from it."""

    near_rms: float
    near_max: float
    away_rms: float
    away_max: float


def distance(run, time, outline):
    """How far the free boundary points of a run are from an outline (r, z)."""
    initial, positions, free = surface_of(run, time)
    points = np.stack([np.linalg.norm(positions[:, :2], axis=1),
                       positions[:, 2]], axis=1)
    off = to_polyline(points, np.stack(outline, axis=1))
    near = free & (initial[:, 2] < NEAR_CLAMP)
    away = free & ~near

    def rms(values):
        return float(np.sqrt(np.mean(values**2)))

    return Distance(rms(off[near]), float(off[near].max()),
                    rms(off[away]), float(off[away].max()))


def to_polyline(points, corners):
    """Distances of points (n, 2) from the line through corners (m, 2)."""
    begin, along = corners[:-1], np.diff(corners, axis=0)
    squares = np.maximum((along**2).sum(axis=1), 1e-300)
    nearest = np.full(len(points), np.inf)
    for start, side, square in zip(begin, along, squares):
        part = np.clip((points - start) @ side / square, 0, 1)
        gap = points - start - part[:, None] * side
        nearest = np.minimum(nearest, (gap**2).sum(axis=1))
    return np.sqrt(nearest)
