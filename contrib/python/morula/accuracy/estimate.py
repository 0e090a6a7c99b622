# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The error of every run, and what is known of it."""
import math
from dataclasses import dataclass, field

import numpy
from morula.scene import normal

from .limits import ROUNDING, limit_of, mean_and_noise, size_of


@dataclass
class Part:
    """What one ladder says at the centre: by how much the value there would
    change (mean over the seeds) if this ladder alone went to its limit."""

    ladder: object
    limit: object          # Limit or None: a setting without a limit
    change: float = math.nan
    uncertainty: float = math.nan
    spread: float = 0.0    # largest less smallest value along the ladder
    used: bool = True      # counts in the sum
    alone: dict = field(default_factory=dict)  # point: value less the limit


@dataclass
class Estimate:
    """One measure at one time: the right value as far as it is known, and
    each point's value, error, noise.

    Where no ladder tells a limit, the right value is the value of one of the
    runs, the finest: errors are then differences from that run, and its own
    error is not known."""

    measure: object
    time: float
    values: dict           # point: mean over the seeds
    scatter: dict          # point: standard deviation over the seeds
    right: float
    uncertainty: float     # of the right value
    from_file: bool
    parts: list
    errors: dict           # point: value - right
    noise: dict            # point: two standard errors of the error
    difference_noise: dict  # point: the same of the value less the centre's
    center: tuple

    def bound(self, point):
        """What the error is at most, as far as can be known."""
        return (abs(self.errors[point]) + self.uncertainty
                + self.noise[point])

    @property
    def compared_with(self):
        """The point whose own value stands for the right one, or None: so too
        where all values agree to rounding."""
        rounding = ROUNDING * max(abs(self.right), 1e-300)
        extrapolated = any(len(part.limit.weights) > 1 for part in self.parts
                           if part.used)
        if self.from_file or extrapolated or self.uncertainty <= rounding:
            return None
        return next((point for point, error in self.errors.items()
                     if abs(error) <= rounding), None)

    @property
    def source(self):
        """Where the right value comes from, in a word or two."""
        if self.from_file:
            return "reference file"
        if not self.compared_with:
            return "ladders"
        return ("finest run" if any(part.used for part in self.parts)
                else "scene's run")

    @property
    def floor(self):
        """Errors below this cannot be told from zero."""
        noise = self.noise.get(self.center, max(self.noise.values()))
        return self.uncertainty + noise

    def effective(self, point):
        """The error, or what cannot be told from zero."""
        return max(abs(self.errors[point]), self.floor)


def center_of(plan, kinds):
    """The point that all lines go through: the scene itself, in a full grid
    the finest corner (the scene's own value, or the first rung, where no value
    is finer)."""
    if not plan.full_grid:
        return plan.own
    values = dict(zip(plan.keys, plan.own))
    for ladder in plan.ladders:
        own = [normal(values[key]) for key in ladder.keys]
        kind = kinds.get(ladder.keys[0], "none")
        sized = [(size_of(rung[0], kind, plan.scene.dimension), rung)
                 for rung in ladder.rungs]
        fine = [pair for pair in sized if pair[0] is not None]
        rung = min(fine)[1] if fine else next(
            (r for r in ladder.rungs if list(map(normal, r)) == own),
            ladder.rungs[0])
        values.update(zip(ladder.keys, rung))
    return plan.known(tuple(values.values()))


def estimate(plan, center, kinds, measure, time, values, reference=None):
    """From the values {point: array over the seeds} of the points that have
    run; the centre must be one of them.

    Without a reference file the right value is the centre's with the changes of
    all ladders added, each to its own limit: exact as far as the errors of the
    ladders add up.
    """
    parts = _parts(plan, center, kinds, values) if center in values else []
    if reference is None:
        right, uncertainty = _sum_of_parts(plan, center, values, parts)
    else:
        right, uncertainty = reference.value(measure, time)
        right = numpy.array([right])
    errors = {p: mean_and_noise(v - right) for p, v in values.items()}
    return Estimate(
        measure, time, {p: float(v.mean()) for p, v in values.items()},
        {p: float(v.std(ddof=1)) if len(v) > 1 else 0.0
         for p, v in values.items()},
        float(right.mean()), uncertainty, reference is not None, parts,
        {p: e[0] for p, e in errors.items()},
        {p: e[1] for p, e in errors.items()},
        {p: mean_and_noise(v - values[center])[1] for p, v in values.items()}
        if center in values else {}, center)


def _sum_of_parts(plan, center, values, parts):
    """The right value seed by seed, and by how much it may be wrong."""
    used = [part for part in parts if part.used]
    if not used:
        # Nothing tends anywhere: the values along the ladders are all there is.
        return values[center], max(part.spread for part in parts)
    changes = [part.limit.apply(_line_values(plan, part.ladder, center, values))
               - values[center] for part in used]
    return values[center] + sum(changes), sum(p.uncertainty for p in used)


def _line_values(plan, ladder, center, values):
    return [values.get(point) for point in plan.line(ladder, center)]


def _parts(plan, center, kinds, values):
    """The ladders in the order given. One whose keys an earlier one has varied
    says its part, but does not count in the sum: the same error would count
    twice."""
    parts, counted = [], set()
    for ladder in plan.ladders:
        part = _part(plan, ladder, center, kinds, values)
        if part.limit is None or counted & set(ladder.keys):
            part.used = False
        else:
            counted |= set(ladder.keys)
        parts.append(part)
    return parts


def _part(plan, ladder, center, kinds, values):
    points = plan.line(ladder, center)
    there = [values.get(point) for point in points]
    kind = kinds.get(ladder.keys[0], "none")
    path = plan.path(ladder, center)
    sizes = [size_of(plan.value(point, ladder.keys[0]), kind,
                     plan.scene.dimension) if point in path else None
             for point in points]
    known = [float(v.mean()) for v in there if v is not None]
    part = Part(ladder, limit_of(sizes, there, kind),
                spread=max(known) - min(known))
    if part.limit is not None:
        limit = part.limit.apply(there)
        part.change = float((limit - values[center]).mean())
        part.uncertainty = part.limit.uncertainty
        part.alone = {point: float((v - limit).mean())
                      for point, v in zip(points, there) if v is not None}
    return part
