# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Uniform growth between slip walls, free on top (the last direction).

F = diag(1, 1, theta Lambda), F_e = diag(1/theta, 1/theta, Lambda), and no
stress across the top: for the neo-Hookean law mu (Lambda^2 - 1) + lambda ln J_e
= 0, where J_e = Lambda / theta^(dim - 1). Projected, the walls give way by the
gap at which the penalty alpha (lambda + 2 mu) / h balances the pressure.
Arguments: the heights in the initial height that published values give, if any.
"""
import sys

import numpy

from tests.common.results import (Results, agree, initial_positions, positions,
                                  root, stresses)

results = Results(sys.argv[1])
dim = results.dimension
up = dim - 1
bottom = (results.numbers("Tissue/Center") - results.numbers("Tissue/Size") / 2)
cells = results.last_cells()
X = initial_positions(cells)
theta = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])[0]



def stress(Lambda):
    b_e = numpy.ones(3)
    b_e[:dim] = theta**-2
    b_e[up] = Lambda**2
    return results.stress_of(b_e)


Lambda = root(lambda L: stress(L)[up], 0.1, 10)
height = theta * Lambda
print("height:", height)
if len(sys.argv) > 2:
    agree("closed form against the published height", height,
          float(sys.argv[2]), 1e-6)

weight = theta**dim if results.per_grown_volume() else 1.0
sigma = numpy.diag(weight / height * stress(Lambda))
gap = give = 0.0
if results.is_projected():
    lame_lambda, mu = results.lame()
    stiffness = lame_lambda + 2 * mu
    gap = (numpy.abs(stress(Lambda)).max() * results.number("Grid/Spacing")
           / results.number("Boundary conditions/Nitsche penalty") / stiffness)
    give = stiffness * 2 * gap / results.numbers("Tissue/Size").min()
    print("gap, um:", gap, "and what it relieves, kPa:", give)

exact = X.copy()
exact[:, up] = bottom[up] + height * (X[:, up] - bottom[up])
agree("position, um", positions(cells), exact, 1e-6 + 4 * gap)
agree("stress, kPa", stresses(cells), sigma, 1e-8 + 4 * give)
axis = "xyz"[up]
row = results.statistics()[-1]
agree("height of the surface, um", row[f"{axis}max"] - bottom[up],
      height * results.numbers("Tissue/Size")[up], 1e-6 + 4 * gap)
