# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A pulled bar creeps at sigma / (3 eta), eta = mu tau. What relaxes is the
shear of the step's beginning: a step of dt is slower by 1 + dt / tau.
"""
import sys

import numpy

from tests.common.results import Results, agree

results = Results(sys.argv[1])
mu = results.lame()[1]
tau = results.number("Material/Relaxation time")
dt = results.number("Time/Step")
sigma = results.function("Boundary conditions/Traction", numpy.ones((1, 3)),
                         0.0).ravel()[0]
rows = results.statistics()
length = rows["xmax"] - rows["xmin"]
times = rows["time"]
# The first step is the elastic one.
rate = numpy.polyfit(times[1:], numpy.log(length[1:]), 1)[0]
exact = sigma / (3 * mu * tau)
print("rate, 1/day:", rate, "exact:", exact)
agree("rate of creep, relative", rate / exact, 1, 0.01)
agree("the same with the steps' error", rate / exact * (1 + dt / tau), 1, 1e-3)
