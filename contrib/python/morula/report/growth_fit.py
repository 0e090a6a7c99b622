# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where a curve is exponential, and how sure that is."""
from dataclasses import dataclass

import numpy as np
from morula.fits import RANGE, NothingToFit, fit_exponential, fit_line

LEAST_ROWS = 5
LEAST_GROWTH = 1.02  # last over first value in the range
LEAST_R2 = 0.99


@dataclass(frozen=True)
class Fit:
    """factor · e^{rate t} over a range of days, with the coefficients of
    determination of the logarithm and, to compare, of a straight line."""

    factor: float
    rate: float
    low: float
    high: float
    rows: int
    r2: float
    r2_line: float

    @property
    def exponential(self):
        """Whether the curve may be called so: the fit explains nearly
        everything, and more than a straight line does."""
        return self.r2 >= LEAST_R2 and self.r2 >= self.r2_line

    def __call__(self, time):
        return self.factor * np.exp(self.rate * np.asarray(time))


def range_of_fit(time):
    """Days 2 to 4 as in the paper's Figs. 3 and 4, or the second half of a
    run that has not come so far."""
    if time[-1] >= RANGE[1] - 1e-6:
        return RANGE
    return 0.5 * (time[0] + time[-1]), time[-1]


def fit_growth(time, values):
    """A Fit, or None where there are too few rows or nothing grows."""
    low, high = range_of_fit(time)
    if not min(values) > 0:  # all cells have died
        return None
    try:
        found = fit_exponential(time, values, (low, high))
    except NothingToFit:
        return None
    kept = (time >= low - 1e-6) & (time <= high + 1e-6)
    rows = int(kept.sum())
    t, v = time[kept], values[kept]
    if rows < LEAST_ROWS or v[-1] < LEAST_GROWTH * v[0]:
        return None
    line = fit_line(t, v, (low, high))
    return Fit(found.factor, found.rate, float(low), float(high), rows,
               determination(np.log(v), np.log(found(t))),
               determination(v, line(t)))


def determination(values, fitted):
    """R²: the part of the values' variance that the fit explains."""
    return float(1 - np.sum((values - fitted)**2)
                 / np.sum((values - values.mean())**2))
