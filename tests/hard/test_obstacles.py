# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A rigid obstacle that swallows the tissue.

While there is room, the tissue fills it: F = diag(f_1, f_2) with
sigma_i = (mu (f_i^2 - 1) + lambda ln J)/J, and each wall yields by the pressure over
kappa = alpha E/h, per area at the beginning of the step.
"""
import numpy
from scipy.optimize import fsolve

EDGE = 120.0  # µm
UNTIL = 2.5  # days; beyond, the lattice of cells loses its symmetry
# From day 5.33 on the ceiling is two grid spacings below the floor, and each point
# deeper than one in one of them. A step that begins then is not done.
LAST = 5.5  # days, a multiple of the step


def stretches(results):
    """(f_1, f_2) at the end of each step up to UNTIL."""
    lame_lambda, mu = results.lame()
    kappa = (results.number("Obstacles/room/Stiffness")
             * results.number("Material/Young's modulus")
             / results.number("Grid/Spacing"))
    velocity = float(results.keys["Obstacles/ceiling/Velocity"].split(";")[1])
    times = results.statistics()["time"][1:]
    found = [(1.0, 1.0)]
    for t in times[times <= UNTIL]:
        before = found[-1]

        def gaps(f):
            J = f[0] * f[1]
            sigma = (mu * (numpy.array(f) ** 2 - 1) + lame_lambda * numpy.log(J)) / J
            # the wall across x has an area that goes as f_2
            depth = -sigma * [f[1] / before[1], f[0] / before[0]] / kappa
            return (numpy.array([EDGE, EDGE + velocity * t]) + 2 * depth) / EDGE - f

        found.append(tuple(fsolve(gaps, before, xtol=1e-12)))
    return numpy.array(found)


def test_swallowed(case):
    trial = case.trial("swallowed", "swallowed.prm", exits=(2,), message=(
        "um deep in the obstacle '(room|ceiling)', more than a grid"))
    f = stretches(trial.results)
    volumes = trial.rows["total_volume"][:len(f)]
    case.found(f"volume over the exact one up to t = {UNTIL:g} days",
               numpy.max(numpy.abs(volumes / (EDGE**2 * f.prod(axis=1)) - 1)),
               at_most=1e-3)
    case.found(f"volume at t = {UNTIL:g} days over that at first",
               volumes[-1] / EDGE**2, at_most=0.4)
    case.found("time of the last good state [day]", trial.last("time"), at_least=UNTIL,
               at_most=LAST)
