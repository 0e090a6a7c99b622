# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The error bar of a run: what its parts add up to, and what half of it would cost.

The parts that have a direction, as all runs with such a grid are wrong alike, may add up, so
that their magnitudes do. Where the grid lies and which seed was drawn are independent of them
and of each other: these join in squares."""
import math
from dataclasses import dataclass

import numpy
from morula.columns import pretty
from scipy.stats import t as student

from .limits import HIGHEST_ORDER, LOWEST_ORDER, ROUNDING, observed_order

BIASES, SCATTERS = ("grid", "cells", "step"), ("position", "chance")
CONFIDENCE = 0.9  # that the scatter of a single run is below what is stated
SAFETY = 1.25     # of what is extrapolated
LEAST_EDGE = 3.0  # cells to a grid cell's edge: doc/accuracy-and-cost.md, Advice
EIGHTH = 2 ** 0.125


def bias(values, noise=0.0):
    """How far off the value at ratio 1 is, from {ratio of the sizes: value}, and the order with
    which that falls. Richardson's extrapolation from the coarsest, with the observed order kept
    between 1 and 2; where none is seen, the spread. Differences within the noise are not
    extrapolated."""
    ratios = sorted(values)
    found = [values[ratio] for ratio in ratios]
    spread = max(found) - min(found)
    if spread <= max(noise, ROUNDING * max(map(abs, found))):
        return spread, 1.0
    order = observed_order(ratios, found) if len(found) == 3 else 1.0
    if not LOWEST_ORDER <= order <= HIGHEST_ORDER:
        return SAFETY * spread, 1.0
    order = min(max(order, 1.0), 2.0)
    far = ratios[-1] if ratios[-1] > 1 else ratios[0]
    return SAFETY * abs(values[far] - values[1.0]) / abs(far**order - 1), order


def scatter(values):
    """The standard deviation of a few runs, and what a single one is off by at most."""
    deviation = float(numpy.std(values, ddof=1))
    return deviation, deviation * float(student.ppf((1 + CONFIDENCE) / 2, len(values) - 1))


def total(parts):
    """The sum of {part: error}; None is not known."""
    return math.hypot(sum(parts.get(name) or 0.0 for name in BIASES),
                      *(parts.get(name) or 0.0 for name in SCATTERS))


@dataclass
class Bar:
    """A measure of a run with its error: `parts` by name, `orders` of the biases. The run took
    `seconds`, which fall with `powers` of the `sizes`: grid and cells in um (0: no lattice), the
    step in days."""

    measure: object
    value: float
    parts: dict
    orders: dict
    seconds: float
    sizes: dict
    powers: dict

    @property
    def error(self):
        return total(self.parts)

    def finer(self, eighths):
        """Sizes, number of runs to take the mean of, and seconds, if each part is 2^{-eighths/8}
        of what it was. Smaller grid cells need smaller cells."""
        sizes = {name: size / EIGHTH ** (eighths[name] / self.orders.get(name, 1.0))
                 for name, size in self.sizes.items()}
        edge = min(LEAST_EDGE, self.sizes["grid"] / (self.sizes["cells"] or 1.0))
        sizes["cells"] = min(sizes["cells"], sizes["grid"] / edge)
        runs = EIGHTH ** (2 * eighths["runs"])
        price = math.prod((self.sizes[name] / sizes[name]) ** self.powers[name]
                          for name in sizes if sizes[name])
        return sizes, math.ceil(runs - 1e-9), self.seconds * price * runs

    def half(self):
        """What makes the error half as large: finer() of it, by the cheapest way, an eighth of a
        halving of one part at a time. None if there is no error."""
        eighths = dict.fromkeys((*BIASES, "runs"), 0)

        def left(steps):
            return total({name: (error or 0.0) / EIGHTH ** steps.get(name, steps["runs"])
                          for name, error in self.parts.items()})

        def gain(name):
            more = {**eighths, name: eighths[name] + 1}
            price = math.log(self.finer(more)[2] / self.finer(eighths)[2])
            return math.log(left(eighths) / max(left(more), 1e-300)) / max(price, 1e-3)

        while left(eighths) > self.error / 2:
            eighths[max(eighths, key=gain)] += 1
        return self.finer(eighths) if self.error else None

    def text(self):
        """zmax = 235.7 ± 3.0 µm (grid 2.2, chance 2.0); 41 s; half of it would cost 5 min."""
        last = decimals(self.error or 1e-9 * abs(self.value))
        listed = ", ".join(f"{name} " + ("not known" if error is None else rounded(
            error, min(last + 1, decimals(error)))) for name, error in sorted(
                self.parts.items(), key=lambda part: -(part[1] or 0.0)))
        half = self.half()
        return (f"{self.measure.text} = {rounded(self.value, last)} ± {rounded(self.error, last)} "
                f"{pretty(self.measure.unit)}".rstrip() + f" ({listed}); {duration(self.seconds)}"
                + (f"; half of it would cost {duration(half[2])}" if half else ""))

    def record(self):
        """What errors.json keeps of it."""
        sizes, runs, seconds = self.half() or ({}, None, None)
        return {"value": self.value, "error": self.error, "unit": self.measure.unit,
                "parts": self.parts, "orders": self.orders, "seconds": self.seconds,
                "half": {"seconds": seconds, "runs": runs, **sizes}, "text": self.text()}


def decimals(number):
    """Of two digits of a number."""
    return 1 - math.floor(math.log10(number)) if number else 0


def rounded(number, digits):
    return f"{round(number, digits):,.{max(0, digits)}f}"


def duration(seconds):
    """In words, to two digits."""
    size, unit = next(pair for pair in ((86400, "days"), (3600, "h"), (60, "min"), (0, "s"))
                      if seconds >= 1.5 * pair[0])
    return f"{float(f'{seconds / (size or 1):.2g}'):g} {unit}"
