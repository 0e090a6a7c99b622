# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A column on the ground, free on top, begins to settle against friction.

For small strains ζ ∂u/∂t = M ∂²u/∂Y² - b, M = λ + 2μ, without displacement at
Y = 0 and traction at Y = l0. In backward Euler's method the part of sin(k Y),
k = (n + 1/2) π/l0, is its last value times 1 - (1 + M k²/ζ Δt)^-i after i steps.
Argument: the allowed error of the settling, in units of that of the top.
"""
import sys

import numpy
from morula.run import read_csv

from tests.common.results import Results, agree, initial_positions, positions

results = Results(sys.argv[1])
lame_lambda, mu = results.lame()
M = lame_lambda + 2 * mu
length = results.numbers("Tissue/Size")[1]
step = results.number("Time/Step")
origin = numpy.zeros((1, 3))
weight = -results.function("Body force/Force density", origin, 0)[0, 1]
friction = results.function("Friction/Coefficient", origin, 0)[0]

for file in results.outputs("cells")[1:]:
    cells = read_csv(file)
    Y = initial_positions(cells)[:, 1]
    steps = round(cells["time"][0] / step)
    settled = numpy.zeros_like(Y)
    for n in range(200):
        k = (n + 0.5) * numpy.pi / length
        settled += (2 * weight / (length * M * k**3) * numpy.sin(k * Y)
                    * (1 - (1 + M * k**2 / friction * step)**-steps))
    agree(f"settling after {steps} steps",
          (initial_positions(cells) - positions(cells))[:, 1] / settled.max(),
          settled / settled.max(), float(sys.argv[2]))
