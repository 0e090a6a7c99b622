# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Ladders: one length or time varies from run to run, errors against an exact
solution are measured on every rung, and the order at which they fall, or how large
they may be, is asserted."""
import math
from dataclasses import dataclass, field
from io import StringIO

import numpy
import pytest


@dataclass
class Ladder:
    """Runs of a scene, or of several side by side, that differ in one size.

    key: what is set to the sizes, in `unit`. fixed: what stays the same. few: the sizes
    of contrib/check; without, it runs before a version only. others: further keys, or a
    function of the size that gives them. cells: a function of the size that gives
    positions and volumes of cells that are to be read from a file. least_orders:
    error -> order that a straight line through the errors in log-log must reach.
    most: error -> largest error allowed on any rung.
    """

    name: str
    scenes: tuple
    key: str
    fixed: str
    sizes: list
    others: object = field(default_factory=dict)
    cells: object = None
    few: tuple = ()
    least_orders: dict = field(default_factory=dict)
    most: dict = field(default_factory=dict)

    def trials(self, case, size):
        keys = self.others(size) if callable(self.others) else self.others
        keys, files = {self.key: f"{size:.12g}", **keys}, {}
        if self.cells:
            keys.update({"Tissue/Shape": "points",
                         "Tissue/Points file": "{files}/cells.csv"})
            files["cells.csv"] = points_file(*self.cells(size))
        for scene in self.scenes:
            yield case.trial(f"{self.name}/{size:g}/{scene}", scene, keys, files,
                             row=self.name).results

    def climb(self, case, errors):
        """errors(results of each scene...) -> {name: error}. Relative errors have plain
        names, others carry their unit: "outer radius [µm]"."""
        sizes = self.sizes if case.full else self.few
        rungs = [errors(*self.trials(case, size)) for size in sizes]
        found = {name: [rung[name] for rung in rungs] for name in rungs[0]}
        orders = {name: order(sizes, values) for name, values in found.items()}
        asserted = {**{name: f" (≥ {least:g})" for name, least in self.least_orders.items()},
                    **{name: f" (error ≤ {most:g})" for name, most in self.most.items()}}
        case.table.add("ladders", {
            "ladder": self.name, "varied": f"{self.key}: {sizes[0]:g} → {sizes[-1]:g}",
            "fixed": self.fixed, **{
                name: f"{values[0]:.1e} → {values[-1]:.1e}"
                      + (f", order {orders[name]:.1f}" if name not in self.most else "")
                      + asserted.get(name, "") for name, values in found.items()}})
        for name, least in self.least_orders.items():
            case.found(f"{self.name}: order of {name}", orders[name], at_least=least)
        for name, most in self.most.items():
            case.found(f"{self.name}: {name}", numpy.max(found[name]), at_most=most)


def order(sizes, errors):
    """Slope of the error over the size in log-log, by least squares."""
    if len(errors) < 2 or not min(errors) > 0:
        return math.nan
    return numpy.polyfit(numpy.log(sizes), numpy.log(errors), 1)[0]


def ladders(*all_of_case):
    """The decorator of a test of each ladder."""
    return pytest.mark.parametrize("ladder", [
        pytest.param(ladder, id=ladder.name,
                     marks=[] if ladder.few else pytest.mark.release)
        for ladder in all_of_case])


def points_file(X, volumes):
    """The text of a points file of positions (n, dim) in µm and volumes in µm^dim."""
    header = ",".join("xyz"[:X.shape[1]]) + ",volume"
    text = StringIO()
    numpy.savetxt(text, numpy.column_stack([X, volumes]), fmt="%.17g", delimiter=",",
                  header=header, comments="")
    return text.getvalue()


def spacing(ratio, **keys):
    """For ladders of h: cells of L_p = h / ratio, and further keys."""
    return lambda h: {"Tissue/Cell spacing": f"{h / ratio:.12g}", **keys}


def cut(h, L_p):
    """Keys of a grid whose lines run through the middle of the cells, about 0.4 h from
    where they would fit the body; in every direction."""
    offset = (int(0.4 * h / L_p) + 0.5) * L_p
    return {"Grid/Offset": ", ".join(3 * [f"{offset:.12g}"])}


def spacing_and_cut(ratio, **keys):
    """spacing() on cut grids."""
    return lambda h: {**spacing(ratio, **keys)(h), **cut(h, h / ratio)}
