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
        self.tables = [record.run.statistics for record in records if record.finished]

    def end(self, column):
        """Summary of the last values of a column; of none where the scene has
        it not, as that of a surface."""
        return summary([table[column].iloc[-1] for table in self.tables if column in table])

    def course(self, column):
        """Times (days), mean and standard deviation of a column over the runs, up to the end of
        the shortest. Times at which only some runs have a row, because a step of theirs was
        halved, are interpolated linearly in the others. Empty where no run has the column."""
        tables = [table for table in self.tables if column in table]
        if not tables:
            return (numpy.array([]),) * 3
        end = min(table["time"].iloc[-1] for table in tables)
        times = numpy.unique(numpy.concatenate([table["time"] for table in tables]))
        times = times[times <= end]
        values = numpy.array([numpy.interp(times, table["time"], table[column])
                              for table in tables])
        deviation = (values.std(axis=0, ddof=1) if len(values) > 1 else numpy.zeros(len(times)))
        return times, values.mean(axis=0), deviation
