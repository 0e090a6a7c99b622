# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where the values along a ladder tend to, and how sure that is."""
import math
from dataclasses import dataclass

import numpy
from morula.scene import as_number
from scipy.optimize import brentq

# Which way a key becomes finer. 'zero': the error falls with a power of the
# value. 'large': with a power of the number of points, taken as the spacing
# they have on the surface. 'tolerance': the smaller the better, by no law.
# No value of a key that is not named here is the right one.
KINDS = {"Grid/Spacing": "zero", "Tissue/Cell spacing": "zero", "Time/Step": "zero",
         "Tissue/Boundary points": "large", "Solver/Newton tolerance": "tolerance",
         "Solver/Linear tolerance": "tolerance"}

# Observed orders outside this range are no sign of convergence.
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 4.5

# Relative differences below this are rounding.
ROUNDING = 1e-12


def size_of(value, kind, dimension):
    """How coarse a value is: a positive number that tends to zero, or None
    where the value has no place in that order (0 often means 'automatic')."""
    number = as_number(value)
    if kind is None or number is None or number <= 0:
        return None
    return number ** (-1.0 / (dimension - 1)) if kind == "large" else number


@dataclass
class Limit:
    """The limit of the means over the seeds; by how much it may be wrong, and why, in
    the words of doc/accuracy-and-cost.md."""

    value: float
    uncertainty: float
    note: str
    order: float = math.nan


def limit_of(sizes, values, kind):
    """The limit of the values (arrays over the seeds, by rung) on rungs of
    these sizes; rungs without size or value are left out."""
    rungs = sorted((size, i) for i, size in enumerate(sizes)
                   if size is not None and values[i] is not None)
    if len(rungs) < 2 or kind is None or len(dict(rungs)) < len(rungs):
        return None
    arrays = [values[i] for _, i in rungs[:3]]
    q = [float(array.mean()) for array in arrays]
    spread = max(q) - min(q)
    # The same seed draws the same numbers on every rung: differences seed by
    # seed are often much surer than the values themselves.
    noises = [mean_and_noise(array - arrays[0])[1] for array in arrays]
    noise = noises[1]
    if kind == "tolerance":
        return Limit(q[0], abs(q[0] - q[1]) + noise, "")
    if spread <= ROUNDING * max(map(abs, q)):
        return Limit(q[0], spread, "no difference")
    if spread <= max(noises):
        return Limit(q[0], max(spread, noise), "noise")
    if len(q) < 3:
        return Limit(q[0], spread + noise, "two values")
    (fine, _), (next_one, _), (coarse, _) = rungs[:3]
    order = observed_order((fine, next_one, coarse), q)
    if not LOWEST_ORDER <= order <= HIGHEST_ORDER:
        return Limit(q[0], spread + noise, "not asymptotic")
    factor = fine**order / (next_one**order - fine**order)
    return Limit(q[0] + factor * (q[0] - q[1]), factor * (abs(q[0] - q[1]) + noise),
                 f"order {order:.1f}", order)


def observed_order(sizes, values):
    """p of Q(s) = Q* + C s^p through three values, fine to coarse; not a number
    if they are not monotone, or if p is outside 0.05 ... 20."""
    (s1, s2, s3), (q1, q2, q3) = sizes, values

    def mismatch(p):
        return (math.log((s3**p - s2**p) / (s2**p - s1**p)) - math.log((q3 - q2) / (q2 - q1)))

    if (q3 - q2) * (q2 - q1) <= 0 or mismatch(0.05) >= 0 or mismatch(20.0) <= 0:
        return math.nan
    return brentq(mismatch, 0.05, 20.0, xtol=1e-6)


def mean_and_noise(values):
    """Mean over the seeds, and two standard errors of it (0 for one seed)."""
    values = numpy.asarray(values)
    noise = (2.0 * float(values.std(ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else 0.0)
    return float(values.mean()), noise
