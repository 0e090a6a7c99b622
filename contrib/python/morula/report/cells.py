# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The states of the cells, small enough for a page.

Positions and radii are written with 16 bits of the box round all states, fields
with 8 bits of their range."""
import base64
import zlib
from collections import namedtuple

import numpy as np
import pandas
from morula.draw.colours import colours_of, limits_of
from morula.draw.points import radii_of
from morula.run import row_at

from .pictures import colour_bar

# The first that there is gives the colours when the page opens.
DEFAULT_FIELDS = ("type", "energy_density", "volume", "elastic_volume_ratio", "growth_volume_ratio",
                  "generation", "phase", "held_at_checkpoint", "pressure")
PERCENTILES = (0.5, 99.5)
NO_FIELDS = ("time", "id", "parent", "X", "Y", "Z")
SHADES = 256


def fields_of(cells):
    """The columns that can give the colour."""
    return [name for name in cells if name not in NO_FIELDS
            and not name.startswith("displacement_")]


class Packed:
    """Blocks of the page, a text for each state that is shown, and what the page
    must know of them (`about`); `words` say what was left out."""

    def __init__(self, run, fields, wanted, limit):
        self.run, self.fields, self.flat = run, fields, run.dimension == 2
        counts = [int(run.statistics["cells"][row_at(run.statistics, time)]) for time in run.times]
        while counts[-1] == 0:  # all cells are dead: nothing to show
            counts.pop()
        last = len(counts) - 1
        self._read([last])
        per_cell = len(self._block(last, 1)) / counts[last]
        chosen = choose(run.times, counts, per_cell, wanted, limit)
        self._read(chosen.states)
        self.blocks = [self._block(i, chosen.stride) for i in chosen.states]
        self.words = [*chosen.words, *self._left_out()]
        self.about = {
            "flat": self.flat, "low": self.low.tolist(),
            "size": (self.high - self.low).tolist(),
            "states": [{"time": float(run.times[i]), "cells": counts[i],
                        "shown": -(-counts[i] // chosen.stride)}
                       for i in chosen.states],
            "fields": [self._field(name) for name in fields]}

    def _read(self, states):
        """The states, and the ranges of what is packed over all of them."""
        self.tables = {i: self._table(i) for i in states}
        self.whole = pandas.concat(self.tables.values())
        # x, y, z and the radius
        self.low = self.whole.iloc[:, :4].min().to_numpy()
        self.high = self.whole.iloc[:, :4].max().to_numpy()
        self.colours = {}
        for name in self.fields:
            values = self.whole[name].to_numpy()
            self.colours[name] = colours_of(name, values, limits_of(name, values, PERCENTILES),
                                            self.run.type_names)

    def _table(self, i):
        cells = self.run.cells(i)
        table = cells[["x", "y", "z"]].astype(float)
        table["radius"] = radii_of(cells["volume"], self.flat)
        return pandas.concat([table, cells[self.fields]], axis=1)

    def _block(self, i, stride):
        """Of every cell x, y, z and the radius, then the fields one after the
        other: deflated, and written in base64."""
        table = self.tables[i][::stride]
        places = quantised(table.iloc[:, :4], self.low, self.high, "<u2")
        values = [quantised(table[name], *self._limits(name), np.uint8) for name in self.fields]
        content = b"".join(part.tobytes() for part in (places, *values))
        return base64.b64encode(zlib.compress(content, 9)).decode()

    def _limits(self, name):
        return self.colours[name].scale.vmin, self.colours[name].scale.vmax

    def _field(self, name):
        shades = self.colours[name].of(np.linspace(*self._limits(name), SHADES))
        return {"name": name, "shades": shades.ravel().tolist(),
                "bar": colour_bar(self.colours[name].in_dimension(self.run.dimension))}

    def _left_out(self):
        yield (f"Positions are rounded to {max(self.high[:3] - self.low[:3]) / 65535:.2g} "
               "µm, fields to 1/255 of their range; the files of the run have all digits.")
        rest = [name for name in fields_of(self.run.cells(-1)) if name not in self.fields]
        if rest:
            yield f"Columns that are not here: {', '.join(rest)} (--fields)."


def quantised(values, low, high, dtype):
    """Values from low to high as whole numbers from 0 to the largest of the
    type; those beyond become the ends."""
    steps = np.iinfo(dtype).max
    extent = np.asarray(high, dtype=float) - low
    scaled = (np.asarray(values, dtype=float) - low) * (
        steps / np.where(extent > 0, extent, np.inf))
    return np.clip(np.rint(scaled), 0, steps).astype(dtype)


# Numbers of the states that are shown, and every how-manieth cell.
Selection = namedtuple("Selection", "states stride words")


def choose(times, counts, bytes_per_cell, wanted, limit):
    """As many states as fit into the limit (bytes), spread evenly, with the first and the last
    one; if not even these two fit, the last one alone, and if that does not, every second, third
    ... cell of it. `counts` are the cells of each state, `wanted` the most states, or None."""
    total, words, stride = len(counts), [], 1
    for number in range(min(total, wanted or total), 0, -1):
        states = sorted({round(i) for i in np.linspace(total - 1, 0, number)})
        size = sum(counts[i] for i in states) * bytes_per_cell
        if size <= limit:
            break
    else:
        stride = int(np.ceil(size / limit))
        words.append(f"One of {stride} cells is shown.")
    if len(states) < total:
        option = "--states" if len(states) == wanted else "--limit"
        days = ", ".join(f"{times[i]:g}" for i in states)
        words.append(f"Of {total} states that were written, {len(states)} are shown "
                     f"(day {days}; {option}).")
    return Selection(states, stride, words)
