# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A shell (2-D: ring, in plane strain) around a lumen whose volume is given, or
that a gas fills. With a = ln r' and b = ln r/R, equilibrium dP_r/dR = -(d - 1)
(P_r - P_t)/R and compatibility db/dR = (exp(a - b) - 1)/R are solved by shooting
from the wall of the lumen, where b is given, for P_r = 0 outside. Arguments: the
tolerances of the pressure and of the places of the cells, relative.
"""
import sys

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.common.results import Results, agree, initial_positions, positions

results = Results(sys.argv[1])
of_pressure, of_place = float(sys.argv[2]), float(sys.argv[3])
dim = results.dimension
lame_lambda, mu = results.lame()
A = results.number("Tissue/Inner radius")
B = results.number("Tissue/Radius")


def piola(stretch, a, b):
    return (mu * (numpy.exp(2 * stretch) - 1)
            + lame_lambda * (a + (dim - 1) * b)) / numpy.exp(stretch)


def rates(R, state):
    a, b = state
    rate_b = numpy.expm1(a - b) / R
    P_r, P_t = piola(a, a, b), piola(b, a, b)
    by_a = (2 * mu * numpy.exp(2 * a) + lame_lambda) / numpy.exp(a) - P_r
    by_b = lame_lambda * (dim - 1) / numpy.exp(a)
    return [(-(dim - 1) * (P_r - P_t) / R - by_b * rate_b) / by_a, rate_b]


def shell(factor):
    """Pressure and motion where the lumen has this part of its volume."""
    b = numpy.log(factor) / dim

    def solution(a):
        return solve_ivp(rates, (A, B), [a, b], method="DOP853", rtol=1e-12,
                         atol=1e-14, dense_output=True)

    a = brentq(lambda a: piola(*solution(a).y[[0, 0, 1], -1]),
               -(dim - 1) * b - 0.3, 0.3, xtol=1e-14)
    return -piola(a, a, b) / numpy.exp((dim - 1) * b), solution(a).sol


rows = results.statistics()
volume = rows["lumen_volume"] / rows["lumen_volume"][0]
agree("volume of the lumen at t = 0, relative", rows["lumen_volume"][0]
      / (numpy.pi * A**2 if dim == 2 else 4 / 3 * numpy.pi * A**3), 1, 1e-3)
nowhere = numpy.zeros((1, 3))
if results.keys["Boundary conditions/Lumen volume"]:
    wanted = numpy.array([results.function("Boundary conditions/Lumen volume",
                                           nowhere, t)[0] for t in rows["time"]])
    agree("volume of the lumen, relative", volume[1:] / wanted[1:], 1, 1e-7)
    exact = wanted[-1]
else:
    p0 = results.function("Boundary conditions/Lumen pressure", nowhere,
                          rows["time"][-1])[0]
    exact = brentq(lambda V: shell(V)[0] - p0 / V, 1, 5, xtol=1e-12)
    agree("pressure times volume of the gas, relative",
          rows["lumen_pressure"][-1] * volume[-1] / p0, 1, 1e-3)
    agree("volume of the lumen, relative", volume[-1], exact, of_pressure)
pressure, motion = shell(exact)
print("volume", exact, "times that at the start, pressure", pressure, "kPa")
agree("pressure, relative", rows["lumen_pressure"][-1] / pressure, 1,
      of_pressure)
cells = results.last_cells()
X, x = initial_positions(cells)[:, :dim], positions(cells)[:, :dim]
R = numpy.clip(numpy.linalg.norm(X, axis=1), A, B)
agree("places of the cells, of the radius",
      (x - X * numpy.exp(motion(R)[1])[:, None]) / B, 0, of_place)
