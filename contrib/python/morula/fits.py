# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Curves fitted to the columns of statistics.csv."""
from dataclasses import dataclass

import numpy as np

RANGE = (2.0, 4.0)  # days: that of the paper, Figs. 3 and 4


class NothingToFit(Exception):
    """Too few rows lie in the range of the fit."""


@dataclass(frozen=True)
class Exponential:
    """factor · e^{rate t}, rate in 1/day."""

    factor: float
    rate: float

    def __call__(self, time):
        return self.factor * np.exp(self.rate * np.asarray(time))


@dataclass(frozen=True)
class Line:
    """slope · t + constant."""

    slope: float
    constant: float

    def __call__(self, time):
        return self.slope * np.asarray(time) + self.constant


def in_range(time, values, limits):
    low, high = limits
    time, values = np.asarray(time), np.asarray(values)
    kept = (time >= low - 1e-6) & (time <= high + 1e-6)
    if kept.sum() < 2:
        raise NothingToFit(f"{kept.sum()} values between {low:g} and {high:g} days; at least 2 "
                           "are needed: has the run reached that time?")
    return time[kept], values[kept]


def fit_line(time, values, limits=RANGE):
    """Least squares of the values at all step ends in the range (days)."""
    time, values = in_range(time, values, limits)
    return Line(*map(float, np.polyfit(time, values, 1)))


def fit_exponential(time, values, limits=RANGE):
    """Least squares of the logarithm, so that every step counts alike."""
    line = fit_line(time, np.log(values), limits)
    return Exponential(float(np.exp(line.constant)), line.slope)
