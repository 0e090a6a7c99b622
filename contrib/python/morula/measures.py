# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is looked at in a run, a number at a time: for accuracy, sweep and Function."""
import difflib
import re
from dataclasses import dataclass

import numpy

from . import columns
from .cell_types import names_in
from .refusal import Refused
from .run import places, row_at, states

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

    def evaluate(self, run, time=None):
        """The number in a Run on a day, or at its end."""
        if self.kind == "statistics":
            column = run.statistics[self.column]
            return float(column.iloc[-1] if time is None else column[row_at(run.statistics, time)])
        points = run.at(self.kind, time)
        values = (numpy.linalg.norm(places(points) - center_of(run), axis=1)
                  if self.column == "radius" else points[self.column].to_numpy())
        if self.reduction.startswith("p"):
            return float(numpy.percentile(values, int(self.reduction[1:])))
        return float(getattr(numpy, self.reduction)(values))


    def is_in(self, run):
        """Whether the run has such a column."""
        return self.kind != "statistics" or self.column in run.statistics

    def course(self, run):
        """Days and values, of every step or of every state written."""
        if self.kind == "statistics":
            return run.statistics["time"].to_numpy(), run.statistics[self.column].to_numpy()
        days = [day for day, _ in states(run.directory, self.kind)]
        return numpy.array(days), numpy.array([self.evaluate(run, day) for day in days])


def center_of(run):
    """Tissue/Center with three components, um."""
    numbers = [float(x) for x in run.keys["Tissue/Center"].split(",")]
    return numpy.array((numbers[:run.dimension] + [0.0])[:3])


def read_measures(text, keys, option=OPTION):
    """Measures separated by commas, as the option --measure has them.
    @param keys of the scene, of which cells may have types and fields"""
    words = [word.strip() for word in text.split(",")]
    if len(set(words)) < len(words):
        raise Refused(option, text, "each measure once")
    return [read_measure(word, keys, option) for word in words]


def read_measure(word, keys, option=OPTION):
    match = FORM.fullmatch(word)
    if not match:
        raise Refused(option, word, HOW)
    kind = match[1] or match[3] or "statistics"
    column = match[2] or match[5]
    dimension = int(keys["Dimension"])
    known = (columns.statistics_of(keys) if kind == "statistics" else
             {**columns.POINTS[kind], **dict.fromkeys(names_in(keys, "Fields"), "")})
    known = {name: unit for name, unit in known.items()
             if dimension == 3 or name not in columns.FLAT}
    if column not in known:
        near = difflib.get_close_matches(column, known, 1)
        raise Refused(option, word, "one of " + ", ".join(known),
                      "Shape/Numbers = true writes it." if column in columns.SHAPE
                      else f"Did you mean '{near[0]}'?" if near else "")
    return Measure(word, kind, column, match[4] or "mean",
                   columns.unit_in(known[column], dimension))
