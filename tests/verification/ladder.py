# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a verification case is: ladders of runs, errors, and what they must do.

A case varies one length or time in a ladder of runs, measures errors against
an exact solution on every rung, and asserts the order at which they fall, or
how large they may be. Its module stands in cases/ and defines a Case.
"""
from dataclasses import dataclass, field
from pathlib import Path

import numpy

from tests.common.tables import with_powers

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "prm/verification"


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
        words = [f"{name} falls with order {order:g} or more"
                 for name, order in self.least_orders.items()]
        words += [f"{name} is at most {with_powers(f'{most:g}')}"
                  for name, most in self.most.items()]
        size = self.varied.split(" [")[0]
        return (f"`{self.name}`, {size} varied, {self.fixed}: the error of "
                + ", of ".join(words) + ".")

    def wanted(self, full):
        """The rungs to run, from the coarsest to the finest."""
        rungs = [rung for rung in self.rungs if full or not rung.full_only]
        return sorted(rungs, key=lambda rung: -rung.size)


@dataclass
class Case:
    """A verification case.

    errors(results of each scene...) -> {name: error}. Relative errors have
    plain names, others carry their unit: "outer radius [µm]".
    """

    title: str
    reference: str
    ladders: list
    errors: object

    def sentences(self):
        """What the case asserts in ctest, for its page."""
        return [ladder.sentence() for ladder in self.ladders
                if not ladder.full_only]


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

    def shortcomings(self):
        """What the ladder asserts and the errors do not do, as sentences."""
        found = []
        for name, least in self.ladder.least_orders.items():
            if not self.order(name) >= least:
                found.append(f"{self.ladder.name}: {name} falls with order "
                             f"{self.order(name):.2f}, at least {least} is "
                             "expected")
        for name, most in self.ladder.most.items():
            worst = max(self.errors[name], key=lambda e: (e != e, e))
            if not worst <= most:
                found.append(f"{self.ladder.name}: {name} is {worst:.3g}, at "
                             f"most {most:g} is allowed")
        return found


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
