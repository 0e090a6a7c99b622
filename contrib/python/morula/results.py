# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a run has written."""
import functools

import numpy

from .refusal import Refused

# Two times are equal if they agree to this, relative to the larger of them
# and a day.
TIME_SLACK = 1e-9


def read_csv(file, dtype=float):
    """The columns of a CSV file by name; one row still makes arrays. The type
    None is found for each column, which takes some ten times as long. Throws
    Refused if the file is damaged."""
    if dtype is None:
        return numpy.atleast_1d(numpy.genfromtxt(
            file, delimiter=",", names=True, encoding="utf-8", dtype=None))
    with open(file, encoding="utf-8") as stream:
        names = stream.readline().strip().split(",")
        try:
            return numpy.loadtxt(stream, delimiter=",", ndmin=1,
                                 dtype=[(name, dtype) for name in names])
        except ValueError as error:
            raise Refused("The table", file, "a line of names and lines of "
                          "as many numbers", f"{error}.") from None


def same_time(a, b):
    return abs(a - b) <= TIME_SLACK * max(1.0, abs(a), abs(b))


def row_at(statistics, time):
    """Number of the row of statistics.csv at a time."""
    for number, there in enumerate(statistics["time"]):
        if same_time(there, time):
            return number
    raise LookupError(f"statistics.csv has no row for day {time:g}")


@functools.lru_cache(maxsize=1)
def read_points(file):
    """Read once for several measures of one file."""
    return read_csv(file)


def time_of(file):
    """The time of a file of cells or surface, or None if nothing is in it."""
    with file.open(encoding="utf-8") as stream:
        stream.readline()
        first = stream.readline()
    return float(first.split(",")[0]) if first else None


def points_at(directory, kind, time):
    """The file of 'cells' or 'surface' written at a time, read."""
    for file in sorted(directory.glob(f"{kind}-[0-9]*.csv")):
        there = time_of(file)
        if there is not None and same_time(there, time):
            return read_points(file)
    raise LookupError(f"{directory} has no {kind}-NNNN.csv for day {time:g}")
