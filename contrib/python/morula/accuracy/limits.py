# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where the values along a ladder tend to, and how sure that is."""
import math
from dataclasses import dataclass

import numpy
from morula.scene import as_number
from scipy.optimize import brentq, minimize_scalar

# Which way a key becomes finer. 'zero': the error falls with a power of the
# value. 'large': with a power of the number of points, taken as the spacing
# they have on the surface. 'tolerance': the smaller the better, by no law.
# No value of a key that is not named here is the right one.
KINDS = {"Grid/Spacing": "zero", "Tissue/Cell spacing": "zero", "Time/Step": "zero",
         "Tissue/Boundary points": "large", "Solver/Newton tolerance": "tolerance",
         "Solver/Linear tolerance": "tolerance"}

# Observed orders outside this range are no sign of convergence.
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 4.5

# A power law describes values if its root mean square mismatch is at most this
# part of their spread.
LARGEST_MISMATCH = 0.05

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
    """The limit as a combination of the values on the rungs, taken seed by seed; by
    how much it may be wrong, and why, in the words of doc/accuracy-and-cost.md."""

    weights: dict
    uncertainty: float
    note: str
    order: float = math.nan

    def apply(self, values):
        return sum(weight * values[i] for i, weight in self.weights.items())


def limit_of(sizes, values, kind):
    """The limit of the values (arrays over the seeds, by rung) on rungs of
    these sizes; rungs without size or value are left out."""
    rungs = sorted((size, i) for i, size in enumerate(sizes)
                   if size is not None and values[i] is not None)
    if len(rungs) < 2 or kind is None or len(dict(rungs)) < len(rungs):
        return None
    fine = rungs[:3]
    arrays = [values[i] for _, i in fine]
    q = [float(array.mean()) for array in arrays]
    spread = max(q) - min(q)
    # The same seed draws the same numbers on every rung: differences seed by
    # seed are often much surer than the values themselves.
    noises = [mean_and_noise(array - arrays[0])[1] for array in arrays]
    noise = noises[1]

    def finest(uncertainty, note):
        return Limit({fine[0][1]: 1.0}, uncertainty, note)

    if kind == "tolerance":
        return finest(abs(q[0] - q[1]) + noise, "")
    if spread <= ROUNDING * max(map(abs, q)):
        return finest(spread, "no difference")
    if spread <= max(noises):
        return finest(max(spread, noise), "noise")
    if len(q) < 3:
        return finest(spread + noise, "two values")
    return (_richardson(fine, q, noise)
            or _fit(rungs, numpy.array([values[i].mean() for _, i in rungs]), noise)
            or finest(spread + noise, "not asymptotic"))


def _richardson(fine, q, noise):
    """Through the three finest values, or None if they show no order."""
    (s1, first), (s2, second), (s3, _) = fine
    order = observed_order((s1, s2, s3), q)
    if not LOWEST_ORDER <= order <= HIGHEST_ORDER:
        return None
    factor = s1**order / (s2**order - s1**order)
    return Limit({first: 1 + factor, second: -factor},
                 factor * (abs(q[0] - q[1]) + noise), f"order {order:.1f}", order)


def _fit(rungs, q, noise):
    """Q* + C s^p through all rungs by least squares, for values that scatter a
    little; None where it does not describe them, or where rungs are too few."""
    if len(rungs) < 4:
        return None
    sizes = numpy.array([size for size, _ in rungs]) / rungs[-1][0]

    def solve(order):
        """Rows of the pseudo-inverse, and the mean square mismatch."""
        law = numpy.stack([numpy.ones_like(sizes), sizes**order], axis=1)
        inverse = numpy.linalg.pinv(law)
        return inverse, numpy.mean((law @ inverse @ q - q) ** 2)

    order = minimize_scalar(lambda p: solve(p)[1], method="bounded",
                            bounds=(LOWEST_ORDER, HIGHEST_ORDER)).x
    inverse, mismatch = solve(order)
    mismatch = math.sqrt(mismatch)
    at_bound = min(order - LOWEST_ORDER, HIGHEST_ORDER - order) < 0.01
    if at_bound or mismatch > LARGEST_MISMATCH * numpy.ptp(q):
        return None
    weights = {i: float(w) for (_, i), w in zip(rungs, inverse[0])}
    limit = float(inverse[0] @ q)
    return Limit(weights, abs(limit - q[0]) + 2 * mismatch + noise,
                 f"fit of order {order:.1f}", float(order))


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
