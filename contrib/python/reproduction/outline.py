# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Outlines of the half-fixed sphere, and how far they are apart; µm."""
from pathlib import Path

import numpy as np
import pandas
from morula.run import places
from scipy.interpolate import PchipInterpolator

DATA = Path(__file__).resolve().parents[3] / "doc/data"
# Free points that began so low count as near the clamp: twice the coarsest spacing
# of the grids that the paper finds good enough.
NEAR_CLAMP = 100.0
WIDTH = 0.04  # rad, of the local lines; or as much as holds a dozen points


def surface_of(run, state):
    """The boundary points: their z and polar angle (rad) at the start, their r and z
    (n, 2) now, and which are free."""
    surface = run.surface(state)
    initial = surface[["X", "Y", "Z"]].to_numpy(float)
    positions = places(surface)
    profile = np.stack([np.hypot(positions[:, 0], positions[:, 1]), positions[:, 2]], axis=1)
    return (initial[:, 2], np.arccos(initial[:, 2] / np.linalg.norm(initial, axis=1)),
            profile, surface["condition"].to_numpy() == 0)


def profile(run, state, points=800):
    """The outline (n, 2) of r and z of a body of revolution, from bottom to top: the mean over the
    azimuth as a function of the initial polar angle.

    Each initial latitude holds one boundary point, so that a local line through its neighbours,
    weighted by (1 - d³)³ of their angular distance, gives the mean; held and free points are not
    mixed."""
    _, angle, moved, free = surface_of(run, state)
    parts = [smooth(angle[part], moved[part], points // 2) for part in (~free, free) if part.any()]
    line = np.concatenate(parts)
    # The last points are half a patch away from the axis.
    return np.concatenate([[[0, line[0, 1]]], line, [[0, line[-1, 1]]]])


def smooth(angle, moved, points):
    """Local weighted lines through r and z at evenly spaced angles, from the largest
    to the smallest."""
    fewest = min(11, len(angle) - 1)
    offset = angle - np.linspace(angle.max(), angle.min(), points)[:, None]
    distance = np.abs(offset)
    reach = np.maximum(WIDTH, 1.01 * np.partition(distance, fewest, axis=1)[:, [fewest]])
    weight = np.clip(1 - (distance / reach)**3, 0, None)**3
    # The normal equations of each line; its value where the offset is 0.
    zeroth, first, second = (weight * offset**k for k in range(3))
    total, slope, square = (part.sum(axis=1, keepdims=True) for part in (zeroth, first, second))
    return (square * (zeroth @ moved) - slope * (first @ moved)) / (total * square - slope**2)


def distances(run, state, outline):
    """How far the free boundary points are from an outline (n, 2): those near the
    clamp, and those away from it."""
    height, _, moved, free = surface_of(run, state)
    off = to_polyline(moved, outline)
    near = height < NEAR_CLAMP
    return off[free & near], off[free & ~near]


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def to_polyline(points, corners):
    """Distances of points (n, 2) from the line through corners (m, 2)."""
    along = np.diff(corners, axis=0)
    offset = points[:, None] - corners[:-1]
    squares = np.maximum((along**2).sum(axis=1), 1e-300)
    part = np.clip((offset * along).sum(axis=2) / squares, 0, 1)
    return np.linalg.norm(offset - part[:, :, None] * along, axis=2).min(axis=1)


def finite_elements(file, theta):
    """The rows of an independent solution by body-fitted finite elements, a file of
    doc/data, at this stretch."""
    rows = pandas.read_csv(DATA / file)
    return rows[(rows["theta"] - theta).abs() < 1e-3]


def finite_element_values(theta):
    """Its apex, total volume (µm³) and mean energy density (kPa); None at a stretch
    that it does not have."""
    rows = finite_elements("half-fixed-sphere.csv", theta)
    return None if rows.empty else rows.iloc[0]


def finite_element_outline(theta, points=1000):
    """Its free surface (n, 2) from the clamp's edge to the axis, or None; between the initial polar
    angles given by cubics that do not overshoot at the edge, where the outline is singular."""
    rows = finite_elements("half-fixed-sphere-outline.csv", theta)
    if rows.empty:
        return None
    angle = rows["angle"].to_numpy()
    smooth_line = PchipInterpolator(angle, rows[["r", "z"]])
    # As the file itself, closest together at the edge.
    part = np.sqrt(np.linspace(0, 1, points))
    return smooth_line(angle[0] + part * (angle[-1] - angle[0]))[::-1]
