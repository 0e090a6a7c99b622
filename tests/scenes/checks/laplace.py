# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball (2-D: disc) whose surface has a tension, with a pressure besides or
without: J_e is everywhere that at which the material's stress balances
p + (d - 1) gamma / r (Laplace), r = R J_e^(1/d). Argument: the tolerance of the
radius, relative.
"""
import sys

import numpy

from tests.common.results import Results, agree, positions, root, stresses

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
dim = results.dimension
lame_lambda, mu = results.lame()
cells, surface = results.last_cells(), results.last_surface()
t = cells["time"][0]
R = results.number("Tissue/Radius")
X = numpy.zeros((1, 3))
gamma = results.function("Boundary conditions/Surface tension", X, t)[0]
p = results.function("Boundary conditions/Pressure", X, t)[0]


def outside(J):
    return p + (dim - 1) * gamma / (R * J ** (1 / dim))


exact = root(lambda J: (mu * (J ** (2 / dim) - 1) + lame_lambda * numpy.log(J))
             / J + outside(J), 0.2, 1.0)
print("radius over the initial one:", exact ** (1 / dim), "pressure inside, kPa:",
      outside(exact))
assert exact ** (1 / dim) < 0.98
volume = cells["volume"]
mean = numpy.sum(volume) / numpy.sum(volume / cells["elastic_volume_ratio"])
agree("mean radius by the cells' volume, relative",
      (mean / exact) ** (1 / dim), 1, tolerance)
r = numpy.linalg.norm(positions(surface)[:, :dim], axis=1)
agree("mean radius of the surface, relative",
      numpy.average(r, weights=surface["area"]) / (R * exact ** (1 / dim)), 1,
      tolerance)
agree("radius of every patch, relative", r / (R * exact ** (1 / dim)), 1,
      5 * tolerance)
stress = -numpy.einsum("pii->p", stresses(cells)[:, :dim, :dim]) / dim
agree("mean pressure, relative", numpy.sum(volume * stress) / numpy.sum(volume)
      / outside(exact), 1, 10 * tolerance)
