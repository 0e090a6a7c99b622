# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A steady field in a ball whose surface has the field's value.

`first`: used up in proportion to itself. `zero R_N`: used up at a rate of its
own, as long as there is some: none is left within R_N, doc/theory.md (11.5).
"""
import sys

import numpy

from tests.common.results import Results, agree, initial_positions, read_csv

results = Results(sys.argv[1])
cells = read_csv(results.outputs("cells")[0])
R = results.number("Tissue/Radius")
outside = results.number("Fields/oxygen/Value")
r = numpy.linalg.norm(initial_positions(cells), axis=1) / R
volume = cells["volume"]
c = cells["oxygen"]

if sys.argv[2] == "first":
    phi = R * numpy.sqrt(results.number("Fields/oxygen/Consumption")
                         / results.number("Fields/oxygen/Diffusion"))
    exact = numpy.sinh(phi * r) / (r * numpy.sinh(phi))
    agree("concentration, relative", c / outside, exact, 6e-3)
    centre = numpy.average(c[r < 0.15] / exact[r < 0.15]) / outside
    agree("concentration in the centre, relative",
          centre * phi / numpy.sinh(phi), 0.551441, 0.002 * 0.551441)
    agree("mean concentration, relative",
          numpy.average(c, weights=volume) / outside, 0.805972,
          0.002 * 0.805972)
else:
    # Where nothing is used up, nothing is left: by the volume of what is.
    k = 1 / (0.5 + c)
    used = numpy.sum(volume * k * c)
    core = R * (1 - used / (4 / 3 * numpy.pi * R**3))**(1 / 3)
    agree("radius of the core, um", core, float(sys.argv[3]),
          0.02 * float(sys.argv[3]))
    agree("what is left in the core", c[r * R < core - 40], 0, 1e-2 * outside)
# Values come out negative only where next to nothing is left: what they are
# tells nothing, as they are set to 0.
clipped = results.statistics()["oxygen_clipped"][0]
agree("share of the cells that were set to 0", clipped / len(cells), 0,
      0 if sys.argv[2] == "first" else 0.01)
