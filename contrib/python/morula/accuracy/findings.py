# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""All estimates with what the runs cost: fronts, least costs, warnings."""
from dataclasses import dataclass

import numpy
from morula.error_in_time import error_in_time
from morula.execute import cores
from morula.run import row_at

from .front import cheapest, pareto
from .scatter import scatters


@dataclass(frozen=True)
class Cost:
    """What a point takes until a time; means over the samples."""

    wall: float      # s, from the start to the end of that step
    unknowns: float  # the most of any step until then
    memory: float    # MB, peak of the whole run
    in_time: float = numpy.nan  # its own estimate of its error in time


# Attribute of Cost, and how it is written on an axis.
KINDS = {"wall": "wall time [s]", "unknowns": "unknowns",
         "memory": "memory [MB]"}


class Findings:
    """What there is to tell of a request."""

    def __init__(self, request, records, estimates, tissue_center):
        self.request, self.plan = request, request.plan
        self.records, self.estimates = records, estimates
        self.tissue_center = tissue_center
        self.scatters = scatters(self) if request.n_offsets else []
        self.finished = [point for point in self.plan.points
                         if all(r.finished for r in self.of(point))]
        self.costs = {time: {point: self._cost(point, time)
                             for point in self.finished}
                      for time in request.times}

    def of(self, point):
        """The records of a point, one a sample."""
        return [record for (p, _), record in self.records.items()
                if p == point]

    def _cost(self, point, time):
        wall, unknowns, memory, in_time = [], [], [], []
        for record in self.of(point):
            statistics = record.statistics()
            row = row_at(statistics, time)
            wall.append(record.row_seconds(row))
            unknowns.append(statistics["unknowns"][:row + 1].max())
            memory.append(record.peak_bytes / 1e6)
            error = error_in_time(statistics, row)
            in_time.append(numpy.nan if error is None else error)
        return Cost(*(float(numpy.mean(x))
                      for x in (wall, unknowns, memory, in_time)))

    def cost(self, estimate, kind):
        """Costs of the estimate's points, in its order."""
        costs = self.costs[estimate.time]
        return [getattr(costs[point], kind) for point in estimate.values]

    def front(self, estimate, kind="wall"):
        """The points that no other one beats, cheapest first. Errors that
        cannot be told from zero count alike."""
        points = list(estimate.values)
        errors = [estimate.effective(point) for point in points]
        return [points[i] for i in pareto(self.cost(estimate, kind), errors)]

    def wanted(self, estimate):
        """The wanted error in the measure's unit, or None."""
        wanted = self.request.wanted.get(estimate.measure)
        return wanted.absolute(estimate.right) if wanted else None

    def least_cost(self, estimate, kind="wall"):
        """The cheapest point that surely has the wanted error, or None."""
        wanted = self.wanted(estimate)
        if wanted is None:
            return None
        points = list(estimate.values)
        best = cheapest(self.cost(estimate, kind),
                        [estimate.bound(point) for point in points], wanted)
        return None if best is None else points[best]

    def verdict(self, estimate):
        """The answer to --wanted in a sentence, or None."""
        wanted = self.request.wanted.get(estimate.measure)
        if wanted is None:
            return None
        allowed, best = self.wanted(estimate), self.least_cost(estimate)
        name = f"{estimate.measure.text} to {wanted.text}"
        if best is not None:
            cost = self.costs[estimate.time][best]
            return f"{name}: {self.plan.label(best)}, {cost.wall:.3g} s"
        if estimate.uncertainty > allowed:
            what = (f"the {estimate.source} stands for the right value, which"
                    if estimate.compared_with else "the right value itself")
            return (f"{name}: cannot be judged, {what} is only "
                    f"known to {estimate.uncertainty:.2g} "
                    f"{estimate.measure.unit}".rstrip())
        nearest = min(estimate.values, key=estimate.bound)
        return (f"{name}: no run is surely as good; nearest is "
                f"{self.plan.label(nearest)}")

    def warnings(self):
        """What a reader must know before believing the tables."""
        request = self.request
        result = [f"{self.plan.label(point)}{sample.words()}"
                  f": left out, it {record.summary()}"
                  for (point, sample), record in self.records.items()
                  if not record.finished]
        halved = [self.plan.label(point) for point in self.finished
                  if any(r.statistics()["rejected_steps"].any()
                         for r in self.of(point))]
        if halved:
            result.append("steps failed and were halved, so that the time step "
                          "is not what the scene says: " + "; ".join(halved))
        if request.plan.random and len(request.seeds or []) < 2:
            result.append("one random seed: how much of a difference is noise "
                          "is not known; --seeds 1..8 tells")
        if any(record.crowded for record in self.records.values()):
            result.append("runs went on at the same time: their wall times are "
                          "less certain than with --jobs 1")
        if request.ranks > cores():
            result.append(f"{request.ranks} ranks on {cores()} cores: wall "
                          "times mean nothing")
        return result

    def summary(self):
        """The verdicts and the warnings, line by line."""
        verdicts = [self.verdict(estimate) for estimate in self.estimates]
        return ([scatter.words(self.plan) for scatter in self.scatters]
                + [line for line in verdicts if line]
                + ["warning: " + text for text in self.warnings()])
