# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A bar of cells from a file, pulled along z, free across: F = diag(a, a, b),
tau_zz = b T and tau_xx = 0, where T is the force over the cross-section that the
cells fill. The force is summed from the patches that it acts on, and sum
V sigma_zz balances it. Argument: the tolerance.
"""
import sys

import numpy
from scipy.optimize import fsolve

from tests.common.results import Results, agree, positions, read_csv, stresses

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
lame_lambda, mu = results.lame()
cells, surface = results.last_cells(), results.last_surface()
first = read_csv(results.outputs("surface")[0])
t = cells["time"][0]
pull = results.keys["Boundary conditions/Traction"].split(";")[2]
pulled = first["condition"] == 3
force = float(pull.split("*")[0]) * t * first["area"][pulled].sum()
length, width = 120, 80
T = force / width**2
# The edges are round, and no part of the end.
agree("pulled area over the cross-section",
      first["area"][pulled].sum() / width**2, 0.8, 0.1)


def unbalanced(stretches):
    a, b = stretches
    ln_J = numpy.log(a * a * b)
    return [mu * (a * a - 1) + lame_lambda * ln_J,
            mu * (b * b - 1) + lame_lambda * ln_J - b * T]


a, b = fsolve(unbalanced, [0.9, 1.2], xtol=1e-13)
print("F:", a, b, "T, kPa:", T)
assert b > 1.1
x = positions(cells)
middle = abs(cells["Z"] - length / 2) < 31
slope = numpy.polyfit(cells["Z"][middle], x[middle, 2], 1)[0]
agree("stretch along, relative", slope / b, 1, tolerance)
slope = numpy.polyfit(cells["X"][middle], x[middle, 0], 1)[0]
agree("stretch across, relative", slope / a, 1, tolerance)

x, sigma = positions(surface), stresses(cells)[:, 2, 2]
# Beside the round edges points slip along normals of their own.
held = (surface["condition"] == 2) & (first["nz"] < -0.999)
assert held.sum() > 20
agree("held points' height, um", x[held, 2], first["Z"][held], 0.2)
moment = force * numpy.average(x[pulled, 2], weights=first["area"][pulled])
agree("sum V sigma_zz, relative",
      numpy.sum(cells["volume"] * sigma) / moment, 1, tolerance)
