# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is looked at in a run: a number at a time."""
import difflib
import functools
import re
from dataclasses import dataclass

import numpy
from morula import columns
from morula.refusal import Refused
from morula.run import read_csv, row_at, same_time, time_of

REDUCTIONS = {"mean": numpy.mean, "min": numpy.min, "max": numpy.max,
              "sum": numpy.sum, "std": numpy.std, "median": numpy.median}
FORM = ("a column of statistics.csv, or 'cells:column', "
        "'cells:reduction(column)', the same with 'surface:'; reductions are "
        + ", ".join([*REDUCTIONS, "pNN (percentile)"]))


@dataclass(frozen=True)
class Measure:
    """A column of a file and, for the files of points, how its values become
    one; `kind` is 'statistics', 'cells' or 'surface'."""

    text: str
    kind: str
    column: str
    reduction: str
    unit: str

    @property
    def of_surface(self):
        return self.kind == "surface" or (self.kind == "statistics" and
                                          self.column in columns.OF_SURFACE)

    def evaluate(self, record, time, center):
        """The number in a finished run."""
        if self.kind == "statistics":
            statistics = record.statistics()
            return float(statistics[self.column][row_at(statistics, time)])
        points = points_at(record.output, self.kind, time)
        return float(reduce(self.reduction, values_of(points, self.column,
                                                      center)))


def points_at(directory, kind, time):
    """The file of 'cells' or 'surface' written at a time, read."""
    for file in sorted(directory.glob(f"{kind}-[0-9]*.csv")):
        there = time_of(file)
        if there is not None and same_time(there, time):
            return read_once(file)
    raise LookupError(f"{directory} has no {kind}-NNNN.csv for day {time:g}")


# For several measures of one file.
read_once = functools.lru_cache(maxsize=1)(read_csv)


def values_of(points, column, center):
    if column != "radius":
        return points[column]
    position = numpy.stack([points[axis] for axis in "xyz"], axis=1)
    return numpy.linalg.norm(position - center, axis=1)


def reduce(name, values):
    if name.startswith("p"):
        return numpy.percentile(values, int(name[1:]))
    return REDUCTIONS[name](values)


def read_measures(text, keys):
    """The --measure option: measures separated by commas.
    @param keys of the scene, of which cells may have types and fields"""
    if not text:
        raise Refused("--measure", text or "", FORM)
    measures = [read_measure(word.strip(), keys)
                for word in text.split(",")]
    for i, measure in enumerate(measures):
        if measure.text in [other.text for other in measures[:i]]:
            raise Refused("--measure", text, "each measure once",
                          f"'{measure.text}' is there twice.")
    return measures


def read_measure(word, keys):
    dimension = int(keys["Dimension"])
    match = re.fullmatch(r"(?:(\w+):)?(?:(\w+)\()?(\w+)(\)?)", word)
    if not match or bool(match[2]) != bool(match[4]):
        raise Refused("--measure", word, FORM)
    kind, reduction, column = match[1] or "statistics", match[2], match[3]
    if kind == "statistics":
        known = columns.statistics_of(keys)
        if column in columns.EFFORT:
            raise Refused("--measure", word, "a result of the simulation",
                          f"'{column}' says what a step took, it has no "
                          "right value.")
        if reduction:
            raise Refused("--measure", word, FORM, "A row of statistics.csv "
                          "has one value a column: nothing to reduce.")
    elif kind in columns.POINTS:
        known = columns.POINTS[kind]
        reduction = reduction or "mean"
        _check_reduction(word, reduction)
    else:
        raise Refused("--measure", word, FORM, f"There is no file '{kind}'.")
    if column not in known:
        near = difflib.get_close_matches(column, known, 1)
        raise Refused("--measure", word, "one of " + ", ".join(known),
                      f"Did you mean '{near[0]}'?" if near else "")
    if dimension == 2 and column in columns.FLAT:
        raise Refused("--measure", word, "a column that is not zero "
                      "throughout", "The scene is two-dimensional.")
    return Measure(word, kind, column, reduction or "",
                   columns.unit_in(known[column], dimension))


def _check_reduction(word, reduction):
    percentile = re.fullmatch(r"p(\d{1,3})", reduction)
    if reduction in REDUCTIONS or percentile and int(percentile[1]) <= 100:
        return
    raise Refused("--measure", word, "a reduction of "
                  + ", ".join([*REDUCTIONS, "p0 ... p100"]))
