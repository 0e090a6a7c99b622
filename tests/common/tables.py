# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables in the terminal, and exit codes of tools that measure."""
import math
import re

# Exit code of a tool whose figures are all measured and in their tables, but
# not all within the limits that are asserted of them.
UNMET_LIMITS = 3


SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value):
    """Two digits in Markdown: 3.1·10⁻³; zero and ordinary numbers plain."""
    if value == 0 or 0.01 <= abs(value) < 1000 or not math.isfinite(value):
        return f"{value:.2g}"
    return with_powers(f"{value:.1e}")


def with_powers(text):
    """A text whose numbers like 3.1e-03 are written as 3.1·10⁻³, and 1e-3 as
    10⁻³."""
    return re.sub(r"\b(\d(?:\.\d+)?)e([-+]\d+)\b", lambda match: (
        match[1] + "·" if match[1] != "1" else "") + "10"
        + str(int(match[2])).translate(SUPERSCRIPTS), text)


def aligned(header, rows):
    """Lines of columns for the terminal, right-aligned."""
    widths = [max(len(row[i]) for row in [header, *rows])
              for i in range(len(header))]
    return ["  ".join(word.rjust(width) for word, width in zip(row, widths))
            for row in [header, *rows]]
