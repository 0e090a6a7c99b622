# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Isotropic growth in a rigid box: F = I, so F_e = I / theta.

tau = mu (b_e - I) + lambda ln J_e I, and the Cauchy stress is tau counted per
initial volume, det F_g tau per grown volume. In 2-D growth acts in the plane:
b_e,zz = 1.
"""
import sys

import numpy

from tests.common.results import (Results, agree, initial_positions, positions,
                                  stresses)

results = Results(sys.argv[1])
lame_lambda, mu = results.lame()
dim = results.dimension
cells = results.last_cells()
X = initial_positions(cells)

theta = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])
ln_J_e = -dim * numpy.log(theta)
weight = theta**dim if results.per_grown_volume() else 1.0
exact = numpy.zeros((len(cells), 3, 3))
for i in range(3):
    b_e = theta**-2 if i < dim else 1.0
    exact[:, i, i] = weight * (mu * (b_e - 1) + lame_lambda * ln_J_e)

agree("position, um", positions(cells), X, 1e-7)
agree("stress, kPa", stresses(cells), exact, 1e-8)
agree("elastic volume ratio", cells["elastic_volume_ratio"], theta**-dim, 1e-9)
trace = 3 if dim == 3 else 2
energy = (lame_lambda / 2 * ln_J_e**2
          + mu / 2 * (trace * (theta**-2 - 1) - 2 * ln_J_e))
agree("energy density, kPa", cells["energy_density"], energy, 1e-8)
print("pressure in Pa:", -1e3 * exact[0, 0, 0])
