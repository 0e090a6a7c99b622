# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A column under its own weight between slip walls."""
import numpy

from tests.verification.errors import field_errors
from tests.verification.ladder import Ladder, cut, ladders, spacing, spacing_and_cut
from tests.verification.material import cauchy, lame

WEIGHT, LENGTH = 5e-3, 200  # kPa/µm, µm
LAMBDA, MU = lame()
PLANE, SPACE = ("self-weight-2d.prm",), ("self-weight-3d.prm",)
SMOOTH = {"displacement": 1.9, "stress": 0.9}

# Where the grid cuts cells, one point a cell leaves an error of (L_p/h)^2 in a
# layer of grid cells along the surface: at a fixed ratio it falls more slowly.
CUT_AT_FIXED_RATIO = {"displacement": 1.4, "stress": 0.4}
CELLS_WHEN_CUT = {40: 5, 20: 2, 10: 0.625, 5: 0.25}  # h: L_p, µm


def load(stretch):
    """P(L) in kPa, and its derivative."""
    return (MU * (stretch - 1 / stretch)
            + LAMBDA * numpy.log(stretch) / stretch,
            MU * (1 + stretch**-2)
            + LAMBDA * (1 - numpy.log(stretch)) / stretch**2)


def stretch_at(height, t):
    """L at initial heights in µm, by Newton's method."""
    stretch = numpy.ones(len(height))
    for _ in range(50):
        P, slope = load(stretch)
        stretch -= (P + t * WEIGHT * (LENGTH - height)) / slope
    return stretch


def raised(stretch):
    """The integral of L dP: L P minus that of P dL."""
    ln_L = numpy.log(stretch)
    return (stretch * load(stretch)[0] - MU * (stretch**2 / 2 - ln_L)
            - LAMBDA * ln_L**2 / 2)


def motion(X, t):
    """y(Y) is the integral of L dY, and dP = w dY."""
    x = X.copy()
    x[:, -1] = (raised(stretch_at(X[:, -1], t))
                - raised(stretch_at(numpy.zeros(1), t))) / (t * WEIGHT)
    return x


def stress(X, t):
    up = X.shape[1] - 1
    F = numpy.tile(numpy.eye(3), (len(X), 1, 1))
    F[:, up, up] = stretch_at(X[:, -1], t)
    return cauchy(F, lame())


@ladders(
    Ladder("2d-h", PLANE, "Grid/Spacing", "h/L_p = 8, one step", [40, 20, 10, 5],
           spacing(8), few=(40, 20), least_orders=SMOOTH),
    Ladder("2d-h-cut", PLANE, "Grid/Spacing", "h/L_p = 8, cut grid, one step",
           [40, 20, 10, 5], spacing_and_cut(8), least_orders=CUT_AT_FIXED_RATIO),
    Ladder("2d-h-cut-more-cells", PLANE, "Grid/Spacing",
           "h/L_p = 8, 10, 16, 20, cut grid, one step", list(CELLS_WHEN_CUT),
           lambda h: spacing_and_cut(h / CELLS_WHEN_CUT[h])(h),
           few=(40, 20), least_orders=SMOOTH),
    Ladder("2d-cells", PLANE, "Tissue/Cell spacing", "h = 10 µm, one step",
           [5, 2.5, 1.25, 0.625], {"Grid/Spacing": "10"},
           least_orders={"displacement": 1.8, "stress": 1}),
    Ladder("2d-cells-cut", PLANE, "Tissue/Cell spacing", "h = 10 µm, cut grid, one step",
           [5, 2.5, 1.25, 0.625], lambda L_p: {"Grid/Spacing": "10", **cut(10, L_p)},
           least_orders={"displacement": 1.9, "stress": 1.9}),
    Ladder("2d-dt", PLANE, "Time/Step", "h = 10 µm, L_p = 1.25 µm",
           [1, 0.5, 0.25, 0.125, 0.0625],
           {"Grid/Spacing": "10", "Tissue/Cell spacing": "1.25"},
           most={"displacement": 1e-4, "stress": 5e-3}),
    Ladder("3d-h", SPACE, "Grid/Spacing", "h/L_p = 5, one step", [20, 10, 5], spacing(5),
           few=(20, 10), least_orders=SMOOTH))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: field_errors(results, motion, stress))
