# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The error of every run, and what is known of it."""
import math
from dataclasses import dataclass

from .limits import KINDS, limit_of, mean_and_noise, size_of


@dataclass
class Part:
    """By how much the value at the centre would change (mean over the seeds) if
    one ladder alone went to its limit."""

    ladder: object
    limit: object          # Limit or None: a setting without a limit
    spread: float          # largest less smallest value along the ladder
    change: float = math.nan
    uncertainty: float = math.nan
    used: bool = True      # counts in the sum


@dataclass
class Estimate:
    """One measure: the right value as far as it is known, and each point's value, error, noise."""

    measure: object
    center: tuple
    parts: list
    right: float
    uncertainty: float     # of the right value
    from_file: bool
    values: dict           # point: mean over the seeds
    scatter: dict          # point: standard deviation over the seeds
    errors: dict           # point: value - right
    noise: dict            # point: two standard errors of the error

    @property
    def base(self):
        """What differences are told against."""
        return self.right

    @property
    def sum_of_parts(self):
        """The changes of the ladders that count, and their uncertainty."""
        used = [part for part in self.parts if part.used]
        return sum(p.change for p in used), sum(p.uncertainty for p in used)

    @property
    def floor(self):
        """Errors below this cannot be told from zero."""
        noise = self.noise.get(self.center, max(self.noise.values()))
        return self.uncertainty + noise

    def front(self, costs):
        """The points that no other one beats in cost and error, cheapest first;
        errors that cannot be told from zero count alike."""
        errors = {point: max(abs(error), self.floor) for point, error in self.errors.items()}
        best, front = math.inf, []
        for point in sorted(errors, key=lambda p: (costs[p], errors[p])):
            if errors[point] < best:
                best = errors[point]
                front.append(point)
        return front


def estimate(plan, measure, time, values, reference=None):
    """From the values {point: array over the seeds} of the points that have run. Without a
    reference file the right value is the centre's with the changes of all ladders added, each to
    its own limit; of ladders that vary the same key the first one counts."""
    parts, counted, center = [], set(), values.get(plan.own)
    for ladder in plan.ladders if center is not None else []:
        part = _part(plan, ladder, values)
        part.used = part.limit is not None and not counted & set(ladder.keys)
        counted |= set(ladder.keys) if part.used else set()
        parts.append(part)
    if reference:
        right, uncertainty = reference.value(measure, time)
        differences = {point: array - right for point, array in values.items()}
    else:
        right = float(center.mean()) + sum(part.change for part in parts if part.used)
        uncertainty = (sum(part.uncertainty for part in parts if part.used)
                       if counted else max(part.spread for part in parts))
        # seed by seed: what all runs of a seed have in common is no error
        differences = {point: array - center for point, array in values.items()}
    return Estimate(
        measure, plan.own, parts, right, uncertainty, reference is not None,
        {p: float(v.mean()) for p, v in values.items()},
        {p: float(v.std(ddof=1)) if len(v) > 1 else 0.0 for p, v in values.items()},
        {p: float(v.mean()) - right for p, v in values.items()},
        {p: mean_and_noise(difference)[1] for p, difference in differences.items()})


def _part(plan, ladder, values):
    points, path = plan.line(ladder, plan.own), plan.path(ladder, plan.own)
    there = [values.get(point) for point in points]
    kind = KINDS.get(ladder.keys[0])
    sizes = [size_of(plan.value(point, ladder.keys[0]), kind, plan.scene.dimension) if point in path
             else None for point in points]
    known = [float(v.mean()) for v in there if v is not None]
    part = Part(ladder, limit_of(sizes, there, kind), max(known) - min(known))
    if part.limit is not None:
        part.change = part.limit.value - float(values[plan.own].mean())
        part.uncertainty = part.limit.uncertainty
    return part
