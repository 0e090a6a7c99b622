# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Uniform growth between slip walls: exact on aligned grids, near it on cut
ones."""
import numpy
from scipy.optimize import brentq

from tests.verification.errors import field_errors
from tests.verification.ladder import Ladder, cut, ladders, spacing_and_cut
from tests.verification.material import cauchy, lame

THETA = 1.4
PLANE, SPACE = ("confined-growth-2d.prm",), ("confined-growth-3d.prm",)
EXACT = {"displacement": 1e-9, "stress": 1e-8}
CUT = {"displacement": 1.9, "stress": 1.9}
# At fixed h/L_p a layer of grid cells along the surface has equal errors.
CUT_AT_FIXED_RATIO = {"displacement": 1.4, "stress": 0.3}


def height(dim):
    """Final over initial height, theta L."""
    lame_lambda, mu = lame()
    return THETA * brentq(
        lambda L: mu * (L**2 - 1) + lame_lambda * numpy.log(
            L / THETA**(dim - 1)), 0.1, 10, xtol=1e-15, rtol=1e-15)


def motion(X, t):
    x = X.copy()
    x[:, -1] *= height(X.shape[1])
    return x


def stress(X, t):
    dim = X.shape[1]
    F = numpy.eye(3)
    F[dim - 1, dim - 1] = height(dim)
    return numpy.broadcast_to(
        cauchy(F[None], lame(), numpy.array([THETA]), dim), (len(X), 3, 3))


@ladders(
    Ladder("2d-aligned", PLANE, "Grid/Spacing", "L_p = 2 µm, one step", [40, 20, 10],
           {"Tissue/Cell spacing": "2"}, few=(40,), most=EXACT),
    Ladder("3d-aligned", SPACE, "Grid/Spacing", "L_p = 5 µm, one step", [40, 20],
           few=(40,), most=EXACT),
    Ladder("2d-h-cut", PLANE, "Grid/Spacing", "h/L_p = 8, cut grid, one step",
           [20, 10, 5, 2.5], spacing_and_cut(8), least_orders=CUT_AT_FIXED_RATIO),
    Ladder("2d-cells-cut", PLANE, "Tissue/Cell spacing", "h = 20 µm, cut grid, one step",
           [10, 5, 2.5, 1.25, 0.625], lambda L_p: cut(20, L_p),
           few=(10, 5), least_orders=CUT),
    Ladder("2d-dt", PLANE, "Time/Step", "h = 20 µm, L_p = 2.5 µm",
           [1, 0.5, 0.25, 0.125, 0.0625], {"Tissue/Cell spacing": "2.5"},
           most=EXACT),
    Ladder("3d-cells-cut", SPACE, "Tissue/Cell spacing", "h = 20 µm, cut grid, one step",
           [10, 5, 2.5, 1.25], lambda L_p: cut(20, L_p), least_orders=CUT))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: field_errors(results, motion, stress))
