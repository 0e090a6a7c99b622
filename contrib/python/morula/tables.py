# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables of texts: of the user's in CSV, of ours in Markdown."""
from .refusal import Refused


def read_table(option, file):
    """The texts of a CSV file with a line of names and at least one of values, a
    data frame; what follows a '#' is a comment. Throws Refused."""
    import pandas
    try:
        table = pandas.read_csv(file, dtype=str, comment="#", keep_default_na=False,
                                skipinitialspace=True)
    except (OSError, ValueError) as error:  # pandas' own are ValueErrors
        raise Refused(option, file, "a CSV file that can be read", f"{error}.") from None
    # pandas takes a value too many for the name of its row
    if not len(table) or not isinstance(table.index, pandas.RangeIndex):
        raise Refused(option, file, "a line of names and lines of as many values")
    return table.rename(columns=str.strip).applymap(str.strip)


def markdown(header, rows, right=0):
    """The last `right` columns are right-aligned. '|' would end a column."""
    marks = ["---"] * (len(header) - right) + ["---:"] * right
    lines = [[word.replace("|", "\\|") for word in line] for line in (header, *rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in (lines[0], marks, *lines[1:]))
