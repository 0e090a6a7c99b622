# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Uniform growth between slip walls, free on top (the last direction).

F = diag(1, 1, theta Lambda), F_e = diag(1/theta, 1/theta, Lambda), and no
stress across the top: mu (Lambda^2 - 1) + lambda ln J_e = 0, where
J_e = Lambda / theta^(dim - 1). Arguments: the heights in the initial height
that published values give, if any.
"""
import sys

import numpy

from tests.common.results import (Results, agree, initial_positions, positions,
                                  root, stresses)

results = Results(sys.argv[1])
lame_lambda, mu = results.lame()
dim = results.dimension
up = dim - 1
bottom = (results.numbers("Tissue/Center") - results.numbers("Tissue/Size") / 2)
cells = results.last_cells()
X = initial_positions(cells)
theta = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])[0]

ln_J_e = lambda Lambda: numpy.log(Lambda / theta ** (dim - 1))
Lambda = root(lambda L: mu * (L**2 - 1) + lame_lambda * ln_J_e(L), 0.1, 10)
height = theta * Lambda
print("height:", height)
if len(sys.argv) > 2:
    agree("closed form against the published height", height,
          float(sys.argv[2]), 1e-6)

exact = X.copy()
exact[:, up] = bottom[up] + height * (X[:, up] - bottom[up])
agree("position, um", positions(cells), exact, 1e-6)

weight = theta**dim if results.per_grown_volume() else 1.0
sigma = numpy.zeros((3, 3))
for i in range(3):
    b_e = 1.0 if i >= dim else Lambda**2 if i == up else theta**-2
    sigma[i, i] = (weight / height
                   * (mu * (b_e - 1) + lame_lambda * ln_J_e(Lambda)))
agree("stress, kPa", stresses(cells), sigma, 1e-8)
axis = "xyz"[up]
row = results.statistics()[-1]
agree("height of the surface, um", row[f"{axis}max"] - bottom[up],
      height * results.numbers("Tissue/Size")[up], 1e-6)
