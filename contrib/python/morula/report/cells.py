# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The states of the cells and of the surface, small enough for a page.

Positions are written with 16 bits a coordinate of the box round all states,
radii and fields with 8 bits of their range. Cells stand in order of their ids,
which the page finds from the lineage."""
import matplotlib
import numpy as np
from morula.columns import POINTS, STRESS, unit_in
from morula.draw.colours import (FIELDS, WHOLE_NUMBERS, limits_of, meanings,
                                 palette_of, style_of)
from morula.draw.points import radii_of
from morula.run import TIME_SLACK, NoStates, places

from . import selection, shell
from .packing import block, packed, quantised

PERCENTILES = (0.5, 99.5)
NO_FIELDS = ("time", "id", "parent", "X", "Y", "Z")
STEPS = 255


def fields_of(cells):
    """The columns that can give the colour."""
    return [name for name in cells if name not in NO_FIELDS
            and not name.startswith("displacement_")]


def label_of(name, dimension):
    """With its unit; the unit goes into the label of the colour bar."""
    unit = POINTS["cells"].get(name)
    if unit is None and ("pressure" in name or "stress" in name):
        unit = STRESS
    unit = unit_in(unit or "", dimension).replace("um", "µm").replace(
        "^3", "³").replace("^2", "²")
    words = FIELDS.get(name, (name.replace("_", " "),))[0]
    words = words.split(" [")[0].replace("$J_e$", "").replace("$J_g$", "")
    return words.strip(), unit


class Packed:
    """Blocks of the page, and what the page must know of them (`about`)."""

    def __init__(self, run, fields, wanted, limit):
        self.run, self.blocks = run, []
        flat = run.dimension == 2
        counts = [self._count(i) for i in range(len(run.times))]
        while counts[-1] == 0:  # all cells are dead: nothing to show
            counts.pop()
        per_cell = self._bytes_per_cell(fields, len(counts) - 1)
        self.selection = selection.choose(run, counts, per_cell, fields,
                                          wanted, limit)
        self._measure(flat)
        states = [self._pack(shown, i, flat) for shown, i in
                  enumerate(self.selection.states)]
        self.about = {
            "flat": flat, "low": self.low.tolist(),
            "size": (self.high - self.low).tolist(), "radii": self.radii,
            "stride": self.selection.stride, "states": states,
            "fields": [self._field(name) for name in fields]}

    def _count(self, i):
        row = (self.run.statistics["time"] - self.run.times[i]).abs().argmin()
        return int(self.run.statistics["cells"][row])

    def _bytes_per_cell(self, fields, last):
        """In the page, from the last state, the most disordered one."""
        cells = self.run.cells(last)
        size = 0
        for values, dtype in [(cells[c], np.uint16) for c in "xyz"] + [
                (cells[name], np.uint8) for name in ("volume", *fields)]:
            size += len(packed(quantised(values, values.min(), values.max(),
                                         dtype)))
        return size / len(cells)

    def _measure(self, flat):
        """Ranges over all states that are shown."""
        lows, highs, radii, self.ranges, self.meanings = [], [], [], {}, {}
        samples = {name: [] for name in self.selection.fields}
        for i in self.selection.states:
            cells = self.run.cells(i)
            positions = [places(cells)]
            surface = self._surface(i)
            if surface is not None:
                positions.append(places(surface))
            lows += [p.min(axis=0) for p in positions]
            highs += [p.max(axis=0) for p in positions]
            r = radii_of(cells["volume"], flat)
            radii += [r.min(), r.max()]
            for name, values in samples.items():
                values.append(np.asarray(cells[name], dtype=float))
        self.low, self.high = np.min(lows, axis=0), np.max(highs, axis=0)
        self.radii = [float(min(radii)), float(max(radii))]
        for name, values in samples.items():
            values = np.concatenate(values)
            known = meanings(name, self.run.type_names, values)
            self.meanings[name] = known
            self.ranges[name] = range_of(name, values, known)

    def _surface(self, i):
        """The boundary points, or None: a tissue of points has none."""
        try:
            surface = self.run.surface(i)
        except NoStates:
            return None
        return surface if len(surface) else None

    def _positions(self, columns, stride=1):
        return [quantised(columns[c][::stride], self.low[k], self.high[k],
                          np.uint16) for k, c in enumerate("xyz")]

    def _pack(self, shown, i, flat):
        cells, surface = self.run.cells(i), self._surface(i)
        every = self.selection.stride
        radii = radii_of(cells["volume"][::every], flat)
        seen, depth = shell.of(places(cells), cells["volume"],
                               flat or every > 1)
        self.blocks.append(block(f"cells-{shown}", packed(
            *self._positions(cells, every),
            quantised(radii, *self.radii, np.uint8),
            seen[::every].astype(np.uint8))))
        for name in self.selection.fields:
            low, high = self.ranges[name][:2]
            self.blocks.append(block(f"field-{name}-{shown}", packed(
                quantised(cells[name][::every], low, high, np.uint8))))
        if surface is not None:
            self.blocks.append(block(f"surface-{shown}", packed(
                *self._positions(surface),
                surface["condition"].astype(np.uint8))))
        return {"number": int(i), "time": float(self.run.times[i]),
                "cells": len(cells), "shown": len(radii),
                "shell": depth,
                "surface": 0 if surface is None else len(surface),
                **self._before(cells["id"], self.run.times[i])}

    def _before(self, ids, time):
        """How many divisions of the lineage, and how many removals of the
        events, came before a state; None divisions if its cells are not those
        that there then are."""
        found = {"divisions": None, "removed": 0}
        try:
            lineage = self.run.lineage
        except NoStates:
            return found
        births = lineage.birth_time[lineage.founders:]
        born = lineage.founders + 2 * int(
            (births <= time + TIME_SLACK * max(1, time)).sum() // 2)
        mothers = lineage.parent[lineage.founders:born]
        there = np.setdiff1d(np.arange(born), mothers)
        gone = np.setdiff1d(there, ids)
        removals = self.run.events["id"][self.run.events["event"] == "removal"]
        if len(ids) + len(gone) == len(there) and np.array_equal(
                gone, np.sort(removals[:len(gone)])):
            found = {"divisions": (born - lineage.founders) // 2,
                     "removed": len(gone)}
        return found

    def _field(self, name):
        low, high, smallest, largest = self.ranges[name]
        label, unit = label_of(name, self.run.dimension)
        return {"name": name, "label": label, "unit": unit, "low": low,
                "high": high, "min": smallest, "max": largest,
                "whole": name in WHOLE_NUMBERS, "palette": style_of(name)[1],
                "names": {number: word for number, (word, _)
                          in self.meanings[name].items()}}


def range_of(name, values, known):
    """Low and high end of the 255 steps, smallest and largest value; `known`
    is what numbers stand for."""
    smallest, largest = float(values.min()), float(values.max())
    if known:
        return (min(known), max(max(known), min(known) + 1), smallest,
                largest)
    low, high = limits_of(name, values, PERCENTILES)
    if name in WHOLE_NUMBERS:
        high = max(high, low + 1)
    return low, high, smallest, largest


def palettes(known):
    """256 colours for each palette of the fields, as hexadecimal digits;
    `known` is by field what its numbers stand for. Each of these numbers, from
    the first to the last, has its part of the palette of its field's name."""
    found = {}
    for name in sorted({*(style_of(field)[1] for field in known), "hsv"}):
        if known.get(name):
            low, high = min(known[name]), max(known[name])
            numbers = low + np.arange(256) * (high - low + 1) // 256
            colours = matplotlib.colors.to_rgba_array(
                [known[name].get(n, ("", "grey"))[1] for n in numbers])
        else:
            colours = palette_of(name)(np.arange(256))
        found[name] = (255 * colours[:, :3]).round().astype(np.uint8) \
            .tobytes().hex()
    return found
