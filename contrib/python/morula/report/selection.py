# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Which states, fields and cells go into the page."""
from dataclasses import dataclass, field

import numpy as np

# The first that there is gives the colours when the page opens.
DEFAULT_FIELDS = ("type", "energy_density", "volume", "elastic_volume_ratio",
                  "growth_volume_ratio", "generation", "phase",
                  "held_at_checkpoint", "pressure")


@dataclass
class Selection:
    """What the 3-D view shows: numbers of states in Run.times, columns, and
    every how-manieth cell; `words` say what was left out, and why."""

    states: list
    fields: list
    stride: int = 1
    words: list = field(default_factory=list)


def choose(run, counts, bytes_per_cell, fields, wanted, limit):
    """As many states as fit into the limit (bytes), spread evenly, with the
    first and the last one; if not even these two fit, the last one alone, and
    if that does not, every second, third ... cell of it. `counts` are the
    cells of each state, `wanted` the most states, or None."""
    total = len(counts)
    most = total if wanted is None else min(wanted, total)
    choice, words, stride = [], [], 1
    for number in range(most, 0, -1):
        choice = spread(total, number)
        size = sum(counts[i] for i in choice) * bytes_per_cell
        if size <= limit:
            break
    else:
        stride = int(np.ceil(size / limit))
        words.append(f"Of the cells, every {ordinal(stride)} one is shown.")
    if len(choice) < total:
        why = ("as --states asks" if wanted is not None and
               len(choice) == wanted else
               f"to keep the page below {limit / 1e6:g} MB (--limit)")
        days = ", ".join(f"{run.times[i]:g}" for i in choice)
        words.append(f"Of {total} states that were written, {len(choice)} "
                     f"are shown (day {days}), {why}.")
    return Selection(choice, fields, stride, words)


def spread(total, number):
    """So many of 0 ... total - 1; the last one, and the first if there are
    two."""
    if number == 1:
        return [total - 1]
    return sorted({round(i) for i in np.linspace(0, total - 1, number)})


def ordinal(number):
    """2nd, 3rd, 4th, 21st."""
    tail = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{'th' if 10 < number % 100 < 14 else tail}"
