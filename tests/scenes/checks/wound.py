# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A hole of radius a in a disc of radius R that flows closes under the tension
gamma of its edge: v = A/r with the constant pressure 2 eta A / R^2, so that
da/dt = -gamma / (2 eta (1 - a^2/R^2)), eta = mu tau. Argument: the largest
relative error of the mean speed.
"""
import sys

import numpy

from tests.common.results import Results, agree, read_csv

results = Results(sys.argv[1])
tau = results.number("Material/Relaxation time")
assert results.number("Time/Step") >= 0.199 * tau
eta = results.lame()[1] * tau
gamma = results.number("Boundary conditions/Surface tension")
times, inner, outer = [], [], []
for surface in map(read_csv, results.outputs("surface")):
    radius = numpy.hypot(surface["x"], surface["y"])
    of_hole = radius < 130
    times.append(surface["time"][0])
    inner.append(numpy.average(radius[of_hole],
                               weights=surface["area"][of_hole]))
    outer.append(numpy.average(radius[~of_hole],
                               weights=surface["area"][~of_hole]))
inner, outer = numpy.array(inner), numpy.array(outer)
# The elastic part of the first steps is not of the flow.
begin = numpy.flatnonzero(numpy.array(times) > 0.15)[0]
exact = gamma / (2 * eta) / (1 - (inner / outer)**2)[begin:]
speed = (inner[begin] - inner[-1]) / (times[-1] - times[begin])
print("radii:", *inner, "speed, um/day:", speed, "exact:", exact.mean())
agree("speed of the edge, relative", speed / exact.mean(), 1,
      float(sys.argv[2]))
