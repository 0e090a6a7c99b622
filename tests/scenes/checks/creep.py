# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A pulled bar creeps at sigma / (3 eta), eta = mu tau, in steps of any length: the
flow of a step sees how the bar moved in the one before. The first step is the
elastic one; what the next ones do not know yet of the creep fades within a few
steps.
"""
import sys

import numpy

from tests.common.results import Results, agree

results = Results(sys.argv[1])
mu = results.lame()[1]
tau = results.number("Material/Relaxation time")
assert results.number("Time/Step") >= 2 * tau
sigma = results.function("Boundary conditions/Traction", numpy.ones((1, 3)),
                         0.0).ravel()[0]
rows = results.statistics()
length = rows["xmax"] - rows["xmin"]
times = rows["time"]
half = len(times) // 2
rate = numpy.polyfit(times[half:], numpy.log(length[half:]), 1)[0]
exact = sigma / (3 * mu * tau)
print("rate, 1/day:", rate, "exact:", exact)
agree("rate of creep, relative", rate / exact, 1, 0.01)
