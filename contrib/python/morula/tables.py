# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables of texts in Markdown."""


def markdown(header, rows, right=0):
    """The last `right` columns are right-aligned. '|' would end a column."""
    marks = ["---"] * (len(header) - right) + ["---:"] * right
    lines = [[word.replace("|", "\\|") for word in line]
             for line in (header, *rows)]
    return "\n".join("| " + " | ".join(line) + " |"
                     for line in (lines[0], marks, *lines[1:]))
