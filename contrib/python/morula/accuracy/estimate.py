# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The error of every run, and what is known of it."""
import math
from dataclasses import dataclass

from .limits import KINDS, ROUNDING, limit_of, mean_and_noise, size_of


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
    """One measure at one time: the right value as far as it is known, and
    each point's value, error, noise."""

    measure: object
    time: float
    center: tuple
    parts: list
    right: float
    uncertainty: float     # of the right value
    from_file: bool
    values: dict           # point: mean over the seeds
    scatter: dict          # point: standard deviation over the seeds
    errors: dict           # point: value - right
    noise: dict            # point: two standard errors of the error

    def bound(self, point):
        """What the error is at most, as far as can be known."""
        return abs(self.errors[point]) + self.uncertainty + self.noise[point]

    @property
    def compared_with(self):
        """The point whose value stands for the right one where no ladder tells a
        limit, so that its own error is not known; or None."""
        rounding = ROUNDING * max(abs(self.right), 1e-300)
        extrapolated = any(len(part.limit.weights) > 1 for part in self.parts if part.used)
        if self.from_file or extrapolated or self.uncertainty <= rounding:
            return None
        return next((point for point, error in self.errors.items() if abs(error) <= rounding), None)

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
    def source(self):
        """Where the right value comes from, in a word or two."""
        if self.from_file:
            return "reference file"
        if not self.compared_with:
            return "ladders"
        return ("finest run" if any(part.used for part in self.parts) else "scene's run")

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

    def cheapest(self, costs, wanted):
        """The cheapest point that surely has the wanted error, or None."""
        good = [point for point in self.values if self.bound(point) <= wanted]
        return min(good, key=costs.get, default=None)


def estimate(plan, measure, time, values, reference=None):
    """From the values {point: array over the seeds} of the points that have run. Without a
    reference file the right value is the centre's with the changes of all ladders added, each to
    its own limit; of ladders that vary the same key the first one counts."""
    parts, counted, changes, center = [], set(), [], plan.own
    for ladder in plan.ladders if center in values else []:
        part, limit = _part(plan, ladder, values)
        part.used = part.limit is not None and not counted & set(ladder.keys)
        if part.used:
            counted |= set(ladder.keys)
            changes.append(limit - values[center])
        parts.append(part)
    if reference is None:
        right = values[center] + sum(changes)
        uncertainty = (sum(part.uncertainty for part in parts if part.used)
                       if counted else max(part.spread for part in parts))
    else:
        right, uncertainty = reference.value(measure, time)
    errors = {p: mean_and_noise(v - right) for p, v in values.items()}
    return Estimate(
        measure, time, center, parts,
        float(right if reference else right.mean()), uncertainty,
        reference is not None, {p: float(v.mean()) for p, v in values.items()},
        {p: float(v.std(ddof=1)) if len(v) > 1 else 0.0
         for p, v in values.items()},
        {p: error for p, (error, _) in errors.items()},
        {p: noise for p, (_, noise) in errors.items()})


def _part(plan, ladder, values):
    """The Part of a ladder, and its limit, an array over the seeds."""
    center = plan.own
    points = plan.line(ladder, center)
    there = [values.get(point) for point in points]
    kind = KINDS.get(ladder.keys[0])
    path = plan.path(ladder, center)
    sizes = [size_of(plan.value(point, ladder.keys[0]), kind, plan.scene.dimension) if point in path
             else None for point in points]
    known = [float(v.mean()) for v in there if v is not None]
    part = Part(ladder, limit_of(sizes, there, kind), max(known) - min(known))
    if part.limit is None:
        return part, values[center]
    limit = part.limit.apply(there)
    part.change = float((limit - values[center]).mean())
    part.uncertainty = part.limit.uncertainty
    return part, limit
