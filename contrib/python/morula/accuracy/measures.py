# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is looked at in a run: a number at a time."""
import difflib
import re
from dataclasses import dataclass

import numpy
from morula import columns
from morula.refusal import Refused
from morula.run import places, row_at

OPTION = "--measure"
HOW = ("a column of statistics.csv, or 'cells:column', 'cells:reduction(column)', the same with "
       "'surface:'; reductions are mean, min, max, sum, std, median, p0 ... p100 (percentiles)")
FORM = re.compile(
    r"(?:(?:(cells|surface):)?(\w+))|(?:(cells|surface):"
    r"(mean|min|max|sum|std|median|p\d\d?|p100)\((\w+)\))")


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

    def evaluate(self, run, time, center):
        """The number in a finished Run on a day; `center` is that of `radius`."""
        if self.kind == "statistics":
            return float(run.statistics[self.column][row_at(run.statistics, time)])
        points = run.at(self.kind, time)
        values = (numpy.linalg.norm(places(points) - center, axis=1)
                  if self.column == "radius" else points[self.column].to_numpy())
        if self.reduction.startswith("p"):
            return float(numpy.percentile(values, int(self.reduction[1:])))
        return float(getattr(numpy, self.reduction)(values))


def read_measures(text, keys):
    """The --measure option: measures separated by commas.
    @param keys of the scene, of which cells may have types and fields"""
    words = [word.strip() for word in text.split(",")]
    if len(set(words)) < len(words):
        raise Refused(OPTION, text, "each measure once")
    return [read_measure(word, keys) for word in words]


def read_measure(word, keys):
    match = FORM.fullmatch(word)
    if not match:
        raise Refused(OPTION, word, HOW)
    kind = match[1] or match[3] or "statistics"
    column = match[2] or match[5]
    dimension = int(keys["Dimension"])
    known = (columns.statistics_of(keys) if kind == "statistics" else columns.POINTS[kind])
    known = {name: unit for name, unit in known.items()
             if dimension == 3 or name not in columns.FLAT}
    if column not in known:
        near = difflib.get_close_matches(column, known, 1)
        raise Refused(OPTION, word, "one of " + ", ".join(known),
                      f"Did you mean '{near[0]}'?" if near else "")
    return Measure(word, kind, column, match[4] or "mean",
                   columns.unit_in(known[column], dimension))
