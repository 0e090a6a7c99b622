# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a single run does not show: how far its results depend on where the
grid lies."""
from dataclasses import dataclass

import numpy
from morula.files import write_csv


@dataclass
class Scatter:
    """A measure at a time over the offsets (and seeds) at which a point has
    finished."""

    measure: object
    time: float
    point: tuple
    samples: list
    values: object  # array, one of a sample
    n_failed: int
    right: object   # of the reference file, or None

    @property
    def base(self):
        """What differences are told against: the right value, or the mean."""
        return float(self.values.mean()) if self.right is None else self.right

    def words(self, plan):
        """In a line of the terminal."""
        return (f"{plan.label(self.point)}, day {self.time:g}: "
                f"{self.measure.text} = {self.values.mean():.6g} "
                f"(from {self.values.min():.6g} to {self.values.max():.6g}, "
                f"standard deviation {self.deviation:.2g}) "
                f"{self.measure.unit}".rstrip())

    @property
    def deviation(self):
        return float(self.values.std(ddof=1)) if len(self.values) > 1 else 0.0


def scatters(findings):
    """Those of all points, times and measures, in this order."""
    request, plan = findings.request, findings.plan
    center = findings.tissue_center
    result = []
    for time in request.times:
        for measure in request.measures:
            right = (request.reference.value(measure, time)[0]
                     if request.reference else None)
            for point in plan.points:
                records = {sample: findings.records[point, sample]
                           for sample in request.samples}
                values = {sample: measure.evaluate(record, time, center)
                          for sample, record in records.items()
                          if record.finished}
                if values:
                    result.append(Scatter(
                        measure, time, point, list(values),
                        numpy.array(list(values.values())),
                        len(records) - len(values), right))
    return result


def write_offsets(findings, directory):
    """scatter.csv, the table with all digits, and offsets.csv, all runs."""
    write_csv(directory / "scatter.csv", scatter_rows(findings))
    write_csv(directory / "offsets.csv", run_rows(findings))


def scatter_rows(findings):
    yield [*findings.plan.keys, "time", "measure", "unit", "runs", "failed",
           "mean", "smallest", "largest", "standard_deviation", "right_value"]
    for s in findings.scatters:
        numbers = (s.values.mean(), s.values.min(), s.values.max(),
                   s.deviation)
        yield [*s.point, f"{s.time:.10g}", s.measure.text, s.measure.unit,
               len(s.values), s.n_failed,
               *(f"{number:.10g}" for number in numbers),
               "" if s.right is None else f"{s.right:.10g}"]


def run_rows(findings):
    """A row for every run, time and measure."""
    axes = "xyz"[:findings.request.scene.dimension]
    yield [*findings.plan.keys, "seed", *(f"moved_{a}" for a in axes),
           "time", "measure", "unit", "value", "right_value"]
    for s in findings.scatters:
        for sample, value in zip(s.samples, s.values):
            yield [*s.point, "" if sample.seed is None else sample.seed,
                   *(f"{part:.10g}" for part in sample.moved),
                   f"{s.time:.10g}", s.measure.text, s.measure.unit,
                   f"{value:.10g}",
                   "" if s.right is None else f"{s.right:.10g}"]
