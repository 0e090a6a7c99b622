# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables in the terminal, and exit codes of tools that measure."""
# Exit code of a tool whose figures are all measured and in their tables, but
# not all within the limits that are asserted of them.
UNMET_LIMITS = 3


def aligned(header, rows):
    """Lines of columns for the terminal, right-aligned."""
    widths = [max(len(row[i]) for row in [header, *rows])
              for i in range(len(header))]
    return ["  ".join(word.rjust(width) for word, width in zip(row, widths))
            for row in [header, *rows]]
