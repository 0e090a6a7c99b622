# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Uniform growth under a dead traction along x, free along y, plane strain.

F = diag(a, b), F_e = F / theta; per initial volume the traction's balance is
tau_xx = a t_x, and tau_yy = 0.
"""
import sys

import numpy
from scipy.optimize import fsolve

from tests.common.results import Results, agree

results = Results(sys.argv[1])
lame_lambda, mu = results.lame()
rows = results.statistics()
last = rows[-1]
X = numpy.array([[100.0, 0.0, 0.0]])
theta = results.function("Growth/Isotropic/Stretch", X, last["time"])[0]
traction = results.function("Boundary conditions/Traction", X, last["time"])
traction = numpy.ravel(traction)[0]


def unbalanced(stretches):
    ln_J_e = numpy.log(stretches.prod() / theta**2)
    tau = mu * ((stretches / theta)**2 - 1) + lame_lambda * ln_J_e
    return tau - numpy.array([traction * stretches[0], 0])


a, b = fsolve(unbalanced, [2 * theta, 0.7 * theta], xtol=1e-13)
print("F:", a, b)
size = results.numbers("Tissue/Size")
J_e = a * b / theta**2
energy = (lame_lambda / 2 * numpy.log(J_e)**2
          + mu / 2 * ((a**2 + b**2) / theta**2 - 2 - 2 * numpy.log(J_e)))
agree("length, relative", (last["xmax"] - last["xmin"]) / size[0] / a, 1, 0.01)
agree("width, relative", (last["ymax"] - last["ymin"]) / size[1] / b, 1, 0.01)
agree("energy density, relative", last["mean_energy_density"] / energy, 1,
      0.01)
for end in ("min", "max"):
    agree(f"{end} J_e, relative", last[f"{end}_elastic_volume_ratio"] / J_e, 1,
          0.03)
spacing = results.number("Grid/Spacing")
length = results.number("Tissue/Cell spacing") * a
agree("cells per grid spacing", last["min_cells_per_spacing"],
      spacing / length, 0.04)

# One word of it, at the first step below two.
log = (results.directory / "log.txt").read_text()
assert log.count("fewer than 2 cells fill") == 1, log
first = rows["time"][rows["min_cells_per_spacing"] < 2][0]
assert f"from t = {first:g} day on" in log, (first, log)
