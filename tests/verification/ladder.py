# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cases made of ladders: one length or time varies in a ladder of runs, errors
against an exact solution are measured on every rung, and the order at which they
fall, or how large they may be, is asserted.
"""
from dataclasses import dataclass, field
from functools import partial
from io import StringIO

import numpy

from tests.cases.case import Case, Finding, Trial
from tests.common.tables import with_powers
from tests.verification import report


@dataclass
class Rung:
    """A run of each of the ladder's scenes with the size varied: the keys that
    differ from the scene's, and, if the cells come from a file, a function that
    gives their positions and volumes. Rungs with full_only are not for ctest.
    """

    size: float
    keys: dict
    full_only: bool = False
    cells: object = None


@dataclass
class Ladder:
    """Runs of a scene, or of several side by side, that differ in one size.

    least_orders: error -> order that a straight line through the errors in
    log-log must reach. most: error -> largest error allowed on any rung; for
    errors that do not fall, or must be below a number that users rely on.
    """

    name: str
    scenes: tuple
    varied: str  # as in tables and plots, with the unit: "h [µm]"
    fixed: str  # what stays the same: "h/L_p = 10, one step"
    rungs: list
    least_orders: dict = field(default_factory=dict)
    most: dict = field(default_factory=dict)
    full_only: bool = False
    label: str = ""  # in the plots; ladders without are only in the tables

    def __post_init__(self):
        if not self.least_orders and not self.most:
            raise ValueError(f"the ladder {self.name} asserts nothing")

    def sentence(self):
        """What the ladder asserts, for its page."""
        words = []
        if self.least_orders:
            words.append("orders at least " + ", ".join(
                f"{order:g} ({name})"
                for name, order in self.least_orders.items()))
        if self.most:
            words.append("errors at most " + ", ".join(
                f"{with_powers(f'{most:g}')} ({name})"
                for name, most in self.most.items()))
        size = self.varied.split(" [")[0]
        return (f"`{self.name}`, {size} varied, {self.fixed}: "
                + "; ".join(words) + ".")


@dataclass
class Measured:
    """The errors on the rungs of a ladder, coarsest first."""

    ladder: Ladder
    sizes: list
    errors: dict

    def order(self, name):
        """Slope of the error over the size in log-log, by least squares."""
        errors = numpy.array(self.errors[name])
        if len(errors) < 2 or not (errors > 0).all():
            return float("nan")
        return numpy.polyfit(numpy.log(self.sizes), numpy.log(errors), 1)[0]

    def findings(self):
        """What the ladder asserts of the errors."""
        of, says = self.ladder.name, self.ladder.sentence()
        found = [Finding(f"{of}: order of {name}", self.order(name),
                         at_least=least, says=says)
                 for name, least in self.ladder.least_orders.items()]
        return found + [
            Finding(f"{of}: {name}",
                    max(self.errors[name], key=lambda e: (e != e, e)),
                    at_most=most, says=says)
            for name, most in self.ladder.most.items()]


def points_file(layout):
    """The text of a points file of positions (n, dim) in µm and volumes in
    µm^dim, which layout() returns."""
    X, volumes = layout()
    header = ",".join("xyz"[:X.shape[1]]) + ",volume"
    text = StringIO()
    numpy.savetxt(text, numpy.column_stack([X, volumes]), fmt="%.17g",
                  delimiter=",", header=header, comments="")
    return text.getvalue()


def trials_of(ladder):
    """(rung, its trials, one for each scene) of all rungs, coarsest first."""
    for rung in sorted(ladder.rungs, key=lambda rung: -rung.size):
        keys, files = dict(rung.keys), {}
        if rung.cells:
            keys.update({"Tissue/Shape": "points",
                         "Tissue/Points file": "{files}/cells.csv"})
            files["cells.csv"] = partial(points_file, rung.cells)
        yield rung, [Trial(
            f"{ladder.name}/{rung.size:g}/{scene.removesuffix('.prm')}", scene,
            keys=keys, files=files, row=ladder.name,
            full_only=ladder.full_only or rung.full_only)
            for scene in ladder.scenes]


def measured(ladders, errors, runs):
    """The ladders that were run; errors of each rung."""
    found = []
    for ladder in ladders:
        rows = {rung.size: errors(*(runs[trial.name].results
                                    for trial in trials))
                for rung, trials in trials_of(ladder)
                if all(trial.name in runs for trial in trials)}
        if rows:
            first = next(iter(rows.values()))
            found.append(Measured(ladder, list(rows), {
                name: [float(row[name]) for row in rows.values()]
                for name in first}))
    return found


def judge(ladders):
    for ladder in ladders:
        yield from ladder.findings()


def ladder_case(title, reference, ladders, errors):
    """A case of ladders.

    errors(results of each scene...) -> {name: error}. Relative errors have
    plain names, others carry their unit: "outer radius [µm]".
    """
    return Case(
        title=f"{title}; reference: {reference}", judge=judge, report=report,
        trials=[trial for ladder in ladders
                for _, trials in trials_of(ladder) for trial in trials],
        limits=tuple(ladder for ladder in ladders if not ladder.full_only),
        measure=partial(measured, ladders, errors))


def rungs(key, sizes, others=None, full_only=(), cells=None):
    """Rungs that set one key to the sizes; others, a dictionary or a function
    of the size, gives further keys, cells(size) the positions and volumes of
    cells that are to be read from a file."""
    found = []
    for size in sizes:
        keys = others(size) if callable(others) else others or {}
        found.append(Rung(size, {key: f"{size:.12g}", **keys},
                          size in full_only, cells and cells(size)))
    return found


def spacing(ratio, **keys):
    """For rungs() of h: cells of L_p = h / ratio, and further keys."""
    return lambda h: {"Tissue/Cell spacing": f"{h / ratio:.12g}", **keys}


def cut(h, L_p):
    """Keys of a grid whose lines run through the middle of the cells, about
    0.4 h from where they would fit the body; in every direction."""
    offset = (int(0.4 * h / L_p) + 0.5) * L_p
    return {"Grid/Offset": ", ".join(3 * [f"{offset:.12g}"])}


def spacing_and_cut(ratio, **keys):
    """spacing() on cut grids."""
    return lambda h: {**spacing(ratio, **keys)(h), **cut(h, h / ratio)}
