# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue that is held on all sides, while its cells contract along an axis.

F = I, and F_g = diag(a) diag(r) of contraction and relaxation. In each step
F_e = diag(1 / (a r)) loses what the relaxation time of the step's middle lets it
lose of its shear: a mean of that with the contraction of the step's beginning
and of its end. With a yield stress, one of the true stress, in 2-D of its
deviator in the plane, the end alone counts, and it is lost by backward Euler.
Arguments: the largest b_e at the end, if it is known, and how well.
"""
import sys

import numpy
from scipy.integrate import solve_ivp

from tests.common.results import Results, agree, read_csv, root, stresses

results = Results(sys.argv[1])
dim = results.dimension
dt = results.number("Time/Step")
yielding = results.number("Material/Yield stress")
passes = int(results.keys["Material/Relaxation passes"])
keeps_volume = results.keys["Contraction/Keep volume"] == "true"
axis = numpy.flatnonzero([float(x) for x in
                          results.keys["Contraction/Direction"].split(";")])[0]
somewhere = numpy.ones((1, 3))


def contraction(t):
    """The diagonal of F_a, three entries."""
    gamma = results.function("Contraction/Stretch", somewhere, t)[0]
    a = numpy.ones(3)
    a[:dim] = gamma ** (-1 / (dim - 1)) if keeps_volume else 1
    a[axis] = gamma
    return a


def stress(b_e):
    """The true stress."""
    weight = 1 / numpy.sqrt(b_e.prod()) if results.per_grown_volume() else 1
    return weight * results.stress_of(b_e)


def shear(b_e):
    """The von Mises stress of the deviator in the space that flows."""
    sigma = stress(b_e)[:dim]
    return numpy.sqrt(1.5 * ((sigma - sigma.mean()) ** 2).sum())


def after(b_e, ratio):
    """b_e after a step with g = ratio."""
    c = b_e[:dim] / numpy.prod(b_e[:dim]) ** (1 / dim)
    change = 1 / (1 + ratio * c)
    result = b_e.copy()
    result[:dim] *= change / numpy.prod(change) ** (1 / dim)
    return result


def relaxed(b_e, tau):
    if yielding == 0:
        c = b_e[:dim] / numpy.prod(b_e[:dim]) ** (1 / dim)
        flow = solve_ivp(lambda _, g: [numpy.prod(1 / c + g) ** (1 / dim)],
                         (0, dt / tau), [0.0], rtol=1e-12, atol=1e-14)
        return after(b_e, flow.y[0, -1])
    for _ in range(passes):
        ratio = dt / passes / tau
        if shear(b_e) <= yielding:
            continue
        start, whole = b_e, ratio
        ratio = root(lambda r: r - whole * (1 - yielding
                                            / shear(after(start, r))),
                     0.0, whole)
        b_e = after(b_e, ratio)
    return b_e


files = {round(cells["time"][0] / dt): cells
         for cells in map(read_csv, results.outputs("cells"))}
steps = round(results.number("Time/End time") / dt)
r, shears = numpy.ones(3), []
for step in range(1, steps + 1):
    tau = results.function("Material/Relaxation time", somewhere,
                           (step - 0.5) * dt)[0]
    weight = 1 if yielding > 0 else (1 / -numpy.expm1(-dt / tau) - tau / dt)
    end = 1 / (contraction(step * dt) * r)
    begin = 1 / (contraction((step - 1) * dt) * r) if step > 1 else 1
    before = (weight * end + (1 - weight) * begin) ** 2
    D = numpy.sqrt(before / relaxed(before, tau))
    b_e = (end / D) ** 2
    r *= D
    shears.append(shear(b_e))
    if step in files:
        agree(f"stress at step {step}, kPa", stresses(files[step]),
              numpy.diag(stress(b_e)), 1e-7)
        agree("J_e", files[step]["elastic_volume_ratio"],
              numpy.sqrt(b_e.prod()), 1e-9)
print("shear stress, kPa:", *shears)
assert len(files) >= 5 and max(shears) > 1.1 * shears[-1] > 0
if yielding > 0:
    assert yielding < shears[-1] < 1.1 * yielding, shears
if len(sys.argv) > 2:
    agree("largest b_e", b_e.max(), float(sys.argv[2]), float(sys.argv[3]))
