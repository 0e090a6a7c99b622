# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Right values from a file, with what the file says of their uncertainty."""
import numpy
from morula.refusal import Refused
from morula.run import same_time
from morula.tables import read_table

OPTION = "--reference"


class Reference:
    """A CSV file with a column for every measure, named like it, MEASURE_error (by how much the
    value may be wrong; without it zero), and time (day), unless it has a single row."""

    def __init__(self, file):
        self.file = file
        try:
            self.table = read_table(OPTION, file).astype(float)
        except ValueError as error:
            raise Refused(OPTION, file, "a number in every column", f"Not so: {error}.") from None
        errors = self.table.filter(regex="_error$")
        if (not numpy.isfinite(self.table).all(axis=None) or (errors < 0).any(axis=None)):
            raise Refused(OPTION, file, "a finite number in every column, and " "errors >= 0")

    def check(self, measures, time):
        """Refuses a file that does not know what is asked for."""
        for measure in measures:
            if measure.text not in self.table:
                raise Refused(OPTION, self.file, f"a file with the column '{measure.text}'",
                              f"It has {', '.join(self.table)}.")
        self._row(time)

    def value(self, measure, time):
        """The right value and by how much it may be wrong."""
        row = self._row(time)
        return float(row[measure.text]), float(row.get(f"{measure.text}_error", 0.0))

    def _row(self, time):
        found = self.table
        if "time" in found:
            found = found[[same_time(there, time) for there in found["time"]]]
        if len(found) != 1:
            raise Refused(OPTION, self.file, f"one row for day {time:g}", f"It has {len(found)}.")
        return found.iloc[0]
