# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Half a body on a slip plane against the whole body."""
import numpy

from tests.common.results import initial_positions, positions, stresses
from tests.verification.errors import norm
from tests.verification.ladder import Ladder, ladders, spacing, spacing_and_cut

PLANE = ("slip-half-2d.prm", "slip-full-2d.prm")
SPACE = ("slip-half-3d.prm", "slip-full-3d.prm")
SMOOTH = {"displacement": 1.9, "stress": 0.9}


def right_half(cells):
    """The cells with X > 0, in an order that depends on X alone."""
    cells = cells[cells["X"] > 0]
    X = numpy.round(initial_positions(cells), 6)
    return cells[numpy.lexsort(X.T)]


def errors(half, full):
    cells = right_half(half.last_cells())
    exact = right_half(full.last_cells())
    X = initial_positions(exact)
    numpy.testing.assert_allclose(initial_positions(cells), X, atol=1e-6)
    V_0, V = exact["initial_volume"], exact["volume"]
    sigma = stresses(exact)
    return {"displacement": norm(positions(cells) - positions(exact), V_0)
            / norm(positions(exact) - X, V_0),
            "stress": norm(stresses(cells) - sigma, V) / norm(sigma, V)}


@ladders(
    Ladder("2d-h", PLANE, "Grid/Spacing", "h/L_p = 8, one step", [40, 20, 10, 5],
           spacing(8), least_orders=SMOOTH),
    Ladder("2d-h-cut", PLANE, "Grid/Spacing", "h/L_p = 8, cut grid, one step",
           [40, 20, 10, 5], spacing_and_cut(8), few=(40, 20), least_orders=SMOOTH),
    Ladder("3d-h", SPACE, "Grid/Spacing", "h/L_p = 5, one step", [40, 20, 10],
           spacing(5), least_orders=SMOOTH))
def test_ladder(case, ladder):
    ladder.climb(case, errors)
