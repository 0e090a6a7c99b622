# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A steady field in a bar: one end has a value, nothing passes the others."""
import sys

import numpy

from tests.common.results import Results, agree, read_csv

results = Results(sys.argv[1])
cells = read_csv(results.outputs("cells")[0])
length = results.numbers("Tissue/Size")[0]
decay = numpy.sqrt(results.number("Fields/signal/Diffusion")
                   / results.number("Fields/signal/Consumption"))
exact = numpy.cosh((length - cells["x"]) / decay) / numpy.cosh(length / decay)
agree("the field", cells["signal"], exact, 2e-3)
agree("the field far from the surface, relative",
      numpy.log(cells["signal"] / exact)[cells["x"] > 50], 0, 5e-3)
