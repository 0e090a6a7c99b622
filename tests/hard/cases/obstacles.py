# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A rigid obstacle that swallows the tissue.

While there is room, the tissue fills it: F = diag(f_1, f_2) with
sigma_i = (mu (f_i^2 - 1) + lambda ln J)/J, and each wall yields by the pressure over
kappa = alpha E/h, per area at the beginning of the step.
"""
import numpy
from scipy.optimize import fsolve

from tests.cases.case import Case, Finding, Limit, Trial

EDGE = 120.0  # µm
UNTIL = 2.5  # days; beyond, the lattice of cells loses its symmetry

# From day 5.33 on the ceiling is two grid spacings below the floor, and each point
# deeper than one in one of them. A step that begins then is not done.
LAST = 5.5  # days, a multiple of the step

VOLUME = Limit("Down to the stretches that the case follows, the volume is "
               "that of the room and of walls that yield, to {at_most:g} of "
               "it.", at_most=1e-3)


def stretches(results):
    """(f_1, f_2) at the end of each step up to UNTIL."""
    lame_lambda, mu = results.lame()
    kappa = (results.number("Obstacles/room/Stiffness")
             * results.number("Material/Young's modulus")
             / results.number("Grid/Spacing"))
    velocity = float(results.keys["Obstacles/ceiling/Velocity"].split(";")[1])
    rows = results.statistics()
    found = [(1.0, 1.0)]
    for t in rows["time"][1:][rows["time"][1:] <= UNTIL]:
        before = found[-1]

        def gaps(f):
            J = f[0] * f[1]
            sigma = (mu * (numpy.array(f) ** 2 - 1)
                     + lame_lambda * numpy.log(J)) / J
            # the wall across x has an area that goes as f_2
            depth = -sigma * [f[1] / before[1], f[0] / before[0]] / kappa
            room = numpy.array([EDGE, EDGE + velocity * t])
            return (room + 2 * depth) / EDGE - f

        found.append(tuple(fsolve(gaps, before, xtol=1e-12)))
    return numpy.array(found)


def judge(runs):
    run = runs["swallowed"]
    f = stretches(run.results)
    volumes = run.results.statistics()["total_volume"][:len(f)]
    yield VOLUME.found(
        f"volume over the exact one up to t = {UNTIL:g} days",
        numpy.max(numpy.abs(volumes / (EDGE**2 * f.prod(axis=1)) - 1)),
        error=True, trial="swallowed")
    yield Finding(f"volume at t = {UNTIL:g} days over that at first",
                  volumes[-1] / EDGE**2, at_most=0.4)
    yield Finding("time of the last good state [day]",
                  run.results.statistics()["time"][-1], at_least=UNTIL,
                  at_most=LAST)


CASE = Case(
    title="An obstacle that swallows the tissue",
    judge=judge, limits=(VOLUME,),
    trials=[
        Trial("swallowed", "swallowed.prm", exit=2,
              message="um deep in the obstacle '(room|ceiling)', more than a grid"),
    ])
