# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Errors of a run against an exact motion, in the L2 norm over the cells."""
import numpy

from tests.common.results import initial_positions, positions, stresses


def norm(values, weights):
    """sqrt of the mean of |values|^2, rows weighted."""
    square = (numpy.asarray(values).reshape(len(weights), -1)**2).sum(axis=1)
    return numpy.sqrt(numpy.average(square, weights=weights))


def field_errors(results, motion, stress):
    """Relative errors of displacement and stress at the end of a run.

    motion(X, t) -> positions in µm, stress(X, t) -> Cauchy stresses in kPa
    (n, 3, 3), for the cells' initial positions X (n, dim). The displacement
    weighs cells by their initial, the stress by their current volume.
    """
    cells = results.last_cells()
    dim, t = results.dimension, cells["time"][0]
    X = initial_positions(cells)[:, :dim]
    x = positions(cells)[:, :dim]
    exact, sigma = motion(X, t), stress(X, t)
    V_0, V = cells["initial_volume"], cells["volume"]
    return {"displacement": norm(x - exact, V_0) / norm(exact - X, V_0),
            "stress": norm(stresses(cells) - sigma, V) / norm(sigma, V)}
