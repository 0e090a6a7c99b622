# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Generalised vortex (Kamojjala & Brannon 2015; de Vaucorbeil et al. 2020)."""
import numpy

from tests.verification.errors import field_errors
from tests.verification.ladder import Ladder, ladders, spacing
from tests.verification.material import cauchy, lame


def angle(R, t):
    """beta and its derivative by R (1/µm) at initial radii R in µm."""
    e = R / 100 - 1
    inside = numpy.abs(e) < 0.25
    q = 1 - 16 * e**2
    t = inside * t
    return t * q**2, -t * 64 * e * q / 100


def rotation(beta):
    """Turns about z by the angles beta."""
    Q = numpy.zeros(beta.shape + (3, 3))
    Q[..., 0, 0] = Q[..., 1, 1] = numpy.cos(beta)
    Q[..., 1, 0] = numpy.sin(beta)
    Q[..., 0, 1] = -Q[..., 1, 0]
    Q[..., 2, 2] = 1
    return Q


def in_space(X):
    return numpy.pad(X, ((0, 0), (0, 3 - X.shape[1])))


def motion(X, t):
    beta, _ = angle(numpy.hypot(X[:, 0], X[:, 1]), t)
    return numpy.einsum("pij,pj->pi", rotation(beta),
                        in_space(X))[:, :X.shape[1]]


def gradient(X, t):
    """F = Q (I + (e_z x X) (x) grad beta)."""
    X = in_space(X)
    R = numpy.hypot(X[:, 0], X[:, 1])
    beta, slope = angle(R, t)
    shear = numpy.zeros((len(X), 3, 3))
    across = numpy.stack([-X[:, 1], X[:, 0]], axis=1)
    shear[:, :2, :2] = (across[:, :, None] * X[:, None, :2]
                        * (slope / R)[:, None, None])
    return rotation(beta) @ (numpy.eye(3) + shear)


PLANE, SPACE = ("vortex-2d.prm",), ("vortex-3d.prm",)
SMOOTH = {"displacement": 1.9, "stress": 0.9}


@ladders(
    Ladder("2d-h", PLANE, "Grid/Spacing", "h/L_p = 8, one step", [15, 10, 7.5, 5],
           spacing(8), few=(15, 10), least_orders=SMOOTH),
    Ladder("2d-h-fixed-cells", PLANE, "Grid/Spacing", "L_p = 0.625 µm, one step",
           [15, 10, 7.5, 5], {"Tissue/Cell spacing": "0.625"}, least_orders=SMOOTH),
    Ladder("2d-cells", PLANE, "Tissue/Cell spacing", "h = 7.5 µm, one step",
           [3.75, 2.5, 1.875, 1.25, 0.9375], {"Grid/Spacing": "7.5"},
           least_orders={"displacement": 1}),
    Ladder("2d-dt", PLANE, "Time/Step", "h = 10 µm, L_p = 1.25 µm",
           [0.5, 0.25, 0.125, 0.0625, 0.03125],
           {"Grid/Spacing": "10", "Tissue/Cell spacing": "1.25"},
           most={"displacement": 0.04, "stress": 0.25}),
    Ladder("3d-h", SPACE, "Grid/Spacing", "h/L_p = 6, one step", [30, 15, 10],
           spacing(6), least_orders=SMOOTH))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: field_errors(
        results, motion, lambda X, t: cauchy(gradient(X, t), lame())))
