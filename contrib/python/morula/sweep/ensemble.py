# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the runs of one combination with different seeds have in common."""
from collections import namedtuple

import numpy
import pandas

# Of n numbers: mean; standard deviation of the single ones (divided by n - 1), and of
# the mean, nan for fewer than two; extremes.
Summary = namedtuple("Summary", "n mean deviation error smallest largest")


def summary(values):
    values = pandas.Series(values, dtype=float)
    return Summary(len(values), values.mean(), values.std(), values.sem(),
                   values.min(), values.max())


class Ensemble:
    """One combination: its finished runs, a table of statistics each."""

    def __init__(self, point, label, records):
        self.point, self.label, self.records = point, label, records
        self.runs = [record.run for record in records if record.finished]

    def end(self, measure):
        """Summary of the last values; of none where the scene has no such column, as that of a
        surface."""
        return summary([measure.evaluate(run) for run in self.runs if measure.is_in(run)])

    def course(self, measure):
        """Times (days), mean and standard deviation over the runs, up to the end of the shortest.
        Times at which only some runs have a row, because a step of theirs was halved, are
        interpolated linearly in the others. Empty where no run has the column."""
        runs = [measure.course(run) for run in self.runs if measure.is_in(run)]
        if not runs:
            return (numpy.array([]),) * 3
        times = numpy.unique(numpy.concatenate([days for days, _ in runs]))
        times = times[times <= min(days[-1] for days, _ in runs)]
        values = numpy.array([numpy.interp(times, *run) for run in runs])
        deviation = (values.std(axis=0, ddof=1) if len(values) > 1 else numpy.zeros(len(times)))
        return times, values.mean(axis=0), deviation
