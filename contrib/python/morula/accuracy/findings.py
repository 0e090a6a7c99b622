# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""All estimates with what the runs cost, and warnings."""
import functools
from collections import namedtuple
from dataclasses import dataclass

import numpy
from morula.error_in_time import error_in_time

from .estimate import estimate


# What a point takes, means over the samples: s of processor time; the most unknowns of
# any step; MB, peak of the run; and its own estimate of its error in time, or nan.
Cost = namedtuple("Cost", "seconds unknowns memory in_time")


@dataclass(frozen=True)
class Scatter:
    """A measure over the samples at which a point has finished."""

    measure: object
    point: tuple
    samples: list
    values: numpy.ndarray  # one of a sample
    n_failed: int
    right: float           # of the reference file, or None

    @property
    def base(self):
        """What differences are told against: the right value, or the mean."""
        return float(self.values.mean()) if self.right is None else self.right

    @property
    def deviation(self):
        return float(self.values.std(ddof=1)) if len(self.values) > 1 else 0.0


class Findings:
    """What there is to tell of a request, from {(point, sample): Record}."""

    def __init__(self, request, records):
        self.request, self.plan, self.records = request, request.plan, records
        self.estimates, self.scatters = [], []
        for measure in request.measures:
            scatters = [self._scatter(measure, point) for point in self.plan.points]
            if request.n_offsets:
                self.scatters += [s for s in scatters if len(s.values)]
            values = {s.point: s.values for s in scatters if not s.n_failed}
            if self.plan.ladders and (self.plan.own in values or values and request.reference):
                self.estimates.append(estimate(self.plan, measure, request.end, values,
                                               request.reference))

    def _scatter(self, measure, point):
        finished = {sample: self.records[point, sample] for sample in self.request.samples
                    if self.records[point, sample].finished}
        values = [measure.evaluate(record.run) for record in finished.values()]
        reference = self.request.reference
        return Scatter(measure, point, list(finished), numpy.array(values),
                       len(self.request.samples) - len(finished),
                       reference.value(measure, self.request.end)[0] if reference else None)

    @functools.cache
    def cost(self, point):
        """The Cost of a point; None if a run of it has failed."""
        records = [self.records[point, sample] for sample in self.request.samples]
        if not all(record.finished for record in records):
            return None
        costs = []
        for record in records:
            statistics = record.run.statistics
            costs.append([record.processor_seconds, statistics["unknowns"].max(),
                          record.peak_bytes / 1e6, error_in_time(statistics)])
        return Cost(*numpy.mean(numpy.array(costs, dtype=float), axis=0))

    def seconds(self, found):
        """Processor time of the points of an Estimate, s."""
        return {point: self.cost(point).seconds for point in found.values}

    def front(self, found):
        return found.front(self.seconds(found))

    def warnings(self):
        """What a reader must know before believing the tables."""
        request, label = self.request, self.plan.label
        for (point, sample), record in self.records.items():
            if not record.finished:
                words = "".join(f", {key} = {value}" for key, value
                                in sample.overrides(request.keys_at(point)))
                yield f"{label(point)}{words}: left out, it {record.summary()}"
            elif record.run.statistics["rejected_steps"].any():
                yield (f"{label(point)}: steps failed and were halved, so that the "
                       "time step is not what the scene says")
        if request.plan.random and len(request.seeds or []) < 2:
            yield ("one random seed: how much of a difference is noise is not "
                   "known; --seeds 1..8 tells")

    def summary(self):
        """Scatter and warnings, line by line."""
        for s in self.scatters:
            yield (f"{self.plan.label(s.point)}: {s.measure.text} = "
                   f"{s.values.mean():.6g} (from {s.values.min():.6g} to {s.values.max():.6g}, "
                   f"standard deviation {s.deviation:.2g}) {s.measure.unit}".rstrip())
        yield from (f"warning: {text}" for text in self.warnings())
