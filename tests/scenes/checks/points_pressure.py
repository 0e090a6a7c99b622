# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells from a file under a uniform pressure: F_e = J_e^(1/3) I everywhere, and
the Cauchy stress per initial volume is
(mu (J_e^(2/3) - 1) + lambda ln J_e) / J_e = -p. Argument: the tolerance of J_e.
"""
import sys

import numpy

from tests.common.results import Results, agree, positions, root, stresses

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
lame_lambda, mu = results.lame()
cells, surface = results.last_cells(), results.last_surface()
t = cells["time"][0]
p = float(results.keys["Boundary conditions/Pressure"].split("*")[0]) * t

exact = root(lambda J: (mu * (J ** (2 / 3) - 1) + lame_lambda * numpy.log(J)) / J
             + p, 0.2, 1.0)
print("J_e:", exact, "pressure, kPa:", p)
assert exact < 0.8
volume = cells["volume"]
mean = numpy.sum(volume) / numpy.sum(volume / cells["elastic_volume_ratio"])
agree("mean J_e, relative", mean / exact, 1, tolerance)
agree("J_e of every cell, relative",
      cells["elastic_volume_ratio"] / exact, 1, 20 * tolerance)
pressure = -numpy.einsum("pii->p", stresses(cells)) / 3
agree("mean pressure, relative",
      numpy.sum(volume * pressure) / numpy.sum(volume) / p, 1, 2 * tolerance)

# The surface is closed: the pressure on it adds up to no force.
normal = numpy.array([surface["nx"], surface["ny"], surface["nz"]]).T
vector = normal * surface["area"][:, None]
agree("sum a n over the area", numpy.linalg.norm(vector.sum(axis=0))
      / surface["area"].sum(), 0, 1e-3)
# It stays around the cells.
enclosed = numpy.einsum("pi,pi", vector, positions(surface)) / 3
agree("enclosed volume over the cells'", enclosed / numpy.sum(volume), 1, 0.02)
