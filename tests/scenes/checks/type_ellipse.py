# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A nearly round drop of one type of cells in another, both Maxwell liquids of the
viscosity eta = mu tau, whatever the step: half the logarithm of its second moments'
ratio falls at l/(1 + l tau), where l = gamma/(2 R eta) in an unbounded plane, and a
part of that in a round dish that slips. The viscosity of the rate l' is
eta/(1 - l' tau), as the elastic strain falls with the stress. The diffuse, smoothed
interface of the splines pulls less than a sharp one, never more. Arguments: by how
much it may be slower, relative; the dish's part, the solution of two Stokes problems
with the second mode.
"""
import sys

import numpy

from tests.common.results import Results, read_csv

results = Results(sys.argv[1])
tolerance, part = map(float, sys.argv[2:4])
times, logs = [], []
for file in results.outputs("cells"):
    cells = read_csv(file)
    drop = cells["type"] == 1
    V = cells["volume"][drop]
    moments = numpy.cov(numpy.stack([cells["x"][drop], cells["y"][drop]]),
                        aweights=V)
    small, large = numpy.linalg.eigvalsh(moments)
    times.append(cells["time"][0])
    logs.append(0.5 * numpy.log(large / small))
    R = (V.sum() / numpy.pi)**0.5
gamma = results.number("Cell types/drop/Tension/With around")
tau = results.number("Material/Relaxation time")
viscous = part * gamma / (2 * R * results.lame()[1] * tau)
exact = viscous / (1 + viscous * tau)
# The stress of the first steps is still elastic.
rate = -numpy.polyfit(times[2:], numpy.log(logs[2:]), 1)[0]
print("logarithms of the axes' ratio:", logs, "rate, 1/day:", rate, "exact:",
      exact, "part:", rate / exact)
assert 1 - tolerance < rate / exact < 1
