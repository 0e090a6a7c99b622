# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A steady field that comes in through the surface of a ball and decays."""
import sys

import numpy

from tests.common.results import Results, agree, initial_positions, read_csv

results = Results(sys.argv[1])
cells = read_csv(results.outputs("cells")[0])
surface = read_csv(results.outputs("surface")[0])
R = results.number("Tissue/Radius")
D, k, q = (results.number(f"Fields/signal/{key}")
           for key in ("Diffusion", "Consumption", "Flux"))
phi = R * numpy.sqrt(k / D)
r = numpy.linalg.norm(initial_positions(cells), axis=1)
exact = (q * R**2 / (D * (phi * numpy.cosh(phi) - numpy.sinh(phi)))
         * numpy.sinh(phi * r / R) / r)
c = cells["signal"]
agree("the field, relative to its largest value", c / exact.max(),
      exact / exact.max(), 1e-2)
agree("the field in the centre, relative", c[r < 0.15 * R] / exact[r < 0.15 * R],
      1, 5e-3)
came_in = q * numpy.sum(surface["area"])
agree("what is used up by what comes in",
      k * numpy.sum(cells["volume"] * c) / came_in, 1, 1e-8)
