# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Right values from a file, with what the file says of their uncertainty."""
import csv
import math
from pathlib import Path

from morula.expressions import evaluate
from morula.refusal import Refused
from morula.run import same_time

OPTION = "--reference"
COLUMN_OPTION = "--reference-column"


class Reference:
    """A CSV file with a column for every measure, named like it, and

    - time: day; one row for every time that is asked for. Without it, one row;
    - MEASURE_error: by how much the value may be wrong; without it, nothing is
      known of that and it counts as zero.

    Columns of other names become these by --reference-column NEW=EXPRESSION,
    computed from the file's columns: zmax=apex, time=10*(theta-1). The error of
    a column that is only renamed goes with it.
    """

    def __init__(self, file, definitions=()):
        self.file = Path(file)
        self.rows = read_rows(self.file)
        for definition in definitions:
            self._define(definition)

    @property
    def columns(self):
        return list(self.rows[0])

    def _define(self, definition):
        new, equals, expression = definition.partition("=")
        new, expression = new.strip(), expression.strip()
        if not equals or not new or not expression:
            raise Refused(COLUMN_OPTION, definition, "NEW=EXPRESSION")
        for row in self.rows:
            row[new] = evaluate(expression, dict(row), COLUMN_OPTION)
            if f"{expression}_error" in row:
                row[f"{new}_error"] = row[f"{expression}_error"]

    def check(self, measures, times):
        """Refuses a file that does not know what is asked for."""
        for measure in measures:
            if measure.text not in self.columns:
                raise Refused(OPTION, self.file, "a file with the column "
                              f"'{measure.text}'", "It has "
                              f"{', '.join(self.columns)}; "
                              f"{COLUMN_OPTION} renames.")
        for time in times:
            self._row(time)

    def value(self, measure, time):
        """The right value and by how much it may be wrong."""
        row = self._row(time)
        return row[measure.text], row.get(f"{measure.text}_error", 0.0)

    def _row(self, time):
        if "time" not in self.columns:
            if len(self.rows) > 1:
                raise Refused(OPTION, self.file, "one row, or a column 'time'",
                              f"It has {len(self.rows)} rows.")
            return self.rows[0]
        found = [row for row in self.rows if same_time(row["time"], time)]
        if len(found) != 1:
            there = ", ".join(f"{row['time']:g}" for row in self.rows)
            raise Refused(OPTION, self.file, f"one row for day {time:g}",
                          f"It has rows for the days {there}; --at chooses "
                          "when the runs are compared.")
        return found[0]


def read_rows(file):
    """The rows of a CSV file as dictionaries of numbers; lines that begin
    with '#' are comments."""
    try:
        lines = [line for line in file.read_text(encoding="utf-8").splitlines()
                 if line.strip() and not line.startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise Refused(OPTION, file, "a CSV file that can be read",
                      str(error)) from None
    rows = []
    for words in csv.DictReader(lines, skipinitialspace=True):
        try:
            row = {name.strip(): float(word) for name, word in words.items()}
        except (ValueError, TypeError, AttributeError):
            row = {"": math.nan}
        if not all(map(math.isfinite, row.values())):
            raise Refused(OPTION, file, "a CSV file with a header line and a "
                          "finite number in every column",
                          f"Row {len(rows) + 1} is another.")
        negative = [name for name, number in row.items()
                    if name.endswith("_error") and number < 0]
        if negative:
            raise Refused(OPTION, file, "errors >= 0",
                          f"'{negative[0]}' is negative.")
        rows.append(row)
    if not rows:
        raise Refused(OPTION, file, "a CSV file with a row of values")
    return rows
