# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables in the terminal and in the documentation."""
import math
import re

# Exit code of a tool whose figures are all measured and in their tables, but
# not all within the limits that are asserted of them.
UNMET_LIMITS = 3


def number(value):
    """Two digits in Markdown: 3.1·10⁻³; zero and ordinary numbers plain."""
    if value == 0 or 0.01 <= abs(value) < 1000 or not math.isfinite(value):
        return f"{value:.2g}"
    digits, power = f"{value:.1e}".split("e")
    superscript = str(int(power)).translate(
        str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{digits}·10{superscript}"


def markdown(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def aligned(header, rows):
    """Lines of columns for the terminal, right-aligned."""
    widths = [max(len(row[i]) for row in [header, *rows])
              for i in range(len(header))]
    return ["  ".join(word.rjust(width) for word, width in zip(row, widths))
            for row in [header, *rows]]


def renew(document, tables):
    """Writes tables (name -> Markdown) between their markers in a document:
    <!-- table NAME --> and <!-- end -->."""
    text = document.read_text()
    for name, table in tables.items():
        begin, end = f"<!-- table {name} -->\n", "<!-- end -->"
        pattern = re.escape(begin) + ".*?" + re.escape(end)
        if not re.search(pattern, text, re.DOTALL):
            raise RuntimeError(f"{document} has no place for the table of "
                               f"{name}: {begin.strip()} ... {end}")
        new = begin + table + "\n" + end
        text = re.sub(pattern, lambda _: new, text, flags=re.DOTALL)
    document.write_text(text)
