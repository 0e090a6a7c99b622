# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The half-fixed sphere by body-fitted finite elements, an independent
solution; used where it is there."""
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

DATA = Path(__file__).resolve().parents[3] / "doc/data"


def rows_at(file, theta):
    """The rows of a file of doc/data at this stretch, None without any."""
    if not (DATA / file).is_file():
        return None
    rows = np.atleast_1d(np.genfromtxt(DATA / file, delimiter=",", names=True))
    rows = rows[np.abs(rows["theta"] - theta) < 1e-3]
    return rows if len(rows) else None


def finite_element_outline(theta, points=1000):
    """(r, z) in µm of the free surface at this stretch from the clamp's edge
    to the axis, or None; between the initial polar angles given by cubics that
    do not overshoot at the edge, where the outline is singular."""
    rows = rows_at("half-fixed-sphere-outline.csv", theta)
    if rows is None:
        return None
    smooth = PchipInterpolator(rows["angle"], np.stack([rows["r"], rows["z"]], 1))
    # As the file itself, closest together at the edge.
    part = np.sqrt(np.linspace(0, 1, points))
    angles = rows["angle"][0] + part * (rows["angle"][-1] - rows["angle"][0])
    return tuple(smooth(angles[::-1]).T)


def finite_element_values(theta):
    """Apex (µm), total volume (µm³) and mean energy density (kPa), or None."""
    rows = rows_at("half-fixed-sphere.csv", theta)
    return None if rows is None else rows[0]
