# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A column between slip walls under its own weight, free on top.

The first Piola-Kirchhoff stress carries the weight above: P(Lambda) =
mu (Lambda - 1/Lambda) + lambda ln Lambda / Lambda = -b (l0 - Y), where b is
the weight per initial volume, Y the initial height (last direction).
Arguments: the allowed errors of stress (in units of b l0, mean over the
cells) and of the settling of the top cells (relative).
"""
import sys

import numpy
from scipy.integrate import trapezoid

from tests.common.results import (Results, agree, initial_positions, positions,
                                  root, stresses)

results = Results(sys.argv[1])
lame_lambda, mu = results.lame()
up = results.dimension - 1
length = results.numbers("Tissue/Size")[up]
cells = results.last_cells()
X = initial_positions(cells)
bottom = (results.numbers("Tissue/Center")[up] - length / 2)
weight = -results.function("Body force/Force density", X,
                           cells["time"][0])[0, up]


def stretch(height):
    load = -weight * (length - height)
    return root(lambda L: mu * (L - 1 / L) + lame_lambda * numpy.log(L) / L
                - load, 0.05, 1.0)


Y = X[:, up] - bottom
# sigma_yy = P F_yy / J = P, as the column keeps its width
stress_error = numpy.abs(stresses(cells)[:, up, up] + weight * (length - Y))
agree("stress in units of b l0", stress_error.mean() / (weight * length), 0.0,
      float(sys.argv[2]))

top = Y == Y.max()
grid = numpy.linspace(0, Y.max(), 2001)
Lambda = numpy.array([stretch(height) for height in grid])
settled = trapezoid(1 - Lambda, grid)
agree("settling of the top cells, relative",
      (X - positions(cells))[top, up] / settled, 1.0, float(sys.argv[3]))
sideways = [d for d in range(3) if d != up]
agree("sideways displacement, um",
      (positions(cells) - X)[:, sideways], 0.0, 1e-2 * settled)
