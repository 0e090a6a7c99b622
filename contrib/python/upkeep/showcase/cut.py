# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A spheroid that is cut to its centre: how much further the lips of the cut
stand apart afterwards, with different growth before, with and without relaxation."""
from dataclasses import dataclass

import numpy
from morula.run import Run
from morula.style import COLOURS, RC, plt

from .spheroids import ROOT

SCENE = ROOT / "prm/showcase/cut.prm"
HALF_WIDTH = 31.0  # um, of the cut
CUT = 1.05  # day, the end of the step in which cells are removed
BEYOND = 120.0  # um from the centre: lips near the surface, of a radius of 150

HEADER = ["growth", "relaxation time, day", "opening, µm", "of the diameter",
          "minutes"]

plt.rcParams.update(RC)


@dataclass(frozen=True)
class Case:
    """The scene with another rate of growth, or with relaxation."""

    name: str
    growth: str  # in words
    relaxation: float  # day
    rate: str = ""  # empty: the file's own

    def overrides(self):
        """What is special in the scene, as (key, value)."""
        keys = ()
        if self.rate:
            keys += (("Growth/Rate/Rate", self.rate),)
        if self.relaxation:
            keys += (("Material/Relaxation time", f"{self.relaxation:g}"),)
        return keys


def all_cases():
    return [Case("cut, rim grows", "rim", 0.0),
            Case("cut, rim grows and relaxes", "rim", 0.05),
            Case("cut, core grows", "core", 0.0,
                 "if(t < 0.99, 0.15*(1 - oxygen), 0)")]


def openings(run):
    """Times from the last output before the cut on, and by how much the lips
    near the surface have moved apart since, um."""
    first = int(numpy.flatnonzero(run.times < CUT - 1e-6)[-1])
    before = run.cells(first).set_index("id")
    lips = before[(before["X"] > BEYOND) & (abs(before["Z"]) < 50)
                  & (abs(before["Y"]) > HALF_WIDTH)
                  & (abs(before["Y"]) < HALF_WIDTH + 11)]
    moved = []
    for i in range(first, len(run.times)):
        now = run.cells(i).set_index("id").loc[lips.index]
        moved.append(2 * (abs(now["y"]) - abs(lips["y"])).mean())
    return run.times[first:], numpy.array(moved)


def opening(run):
    """At the end, um, and as a part of the diameter before the cut."""
    times, moved = openings(run)
    rows = run.statistics
    diameter = numpy.interp(times[0], rows["time"],
                            rows["zmax"] - rows["zmin"])
    return moved[-1], moved[-1] / diameter


def row(case, record):
    moved, part = opening(Run(record.output))
    return [case.growth, f"{case.relaxation:g}" if case.relaxation else "none",
            f"{moved:+.1f}", f"{part:+.3f}",
            f"{record.process_seconds / 60:.1f}"]


def draw(pairs, path):
    """Cells near the plane of the cut's depth, before and after, of (case,
    record of its run)."""
    canvas, panels = plt.subplots(1, len(pairs), squeeze=False,
                                  figsize=(3 * len(pairs), 3.2),
                                  layout="constrained")
    for i, (axes, (case, record)) in enumerate(zip(panels[0], pairs)):
        run = Run(record.output)
        first = int(numpy.flatnonzero(run.times < CUT - 1e-6)[-1])
        left = run.cells(-1)["id"]
        for number, colour in ((first, "#BBBBBB"), (-1, COLOURS[i])):
            cells = run.cells(number)
            shown = cells[cells["id"].isin(left) & (abs(cells["Z"]) < 9)]
            axes.plot(shown["x"], shown["y"], ".", markersize=3, color=colour)
        relaxes = ", relaxes" if case.relaxation else ""
        axes.set(aspect="equal", title=f"{case.growth} grows{relaxes}")
        axes.axis("off")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path)
    plt.close(canvas)
