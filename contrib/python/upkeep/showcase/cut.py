# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A spheroid that is cut to its centre: how much further the lips of the cut
stand apart afterwards, with different growth before, with and without relaxation."""
import numpy
from morula.style import COLOURS, plt

from . import SCENES, Case

SCENE = SCENES / "cut.prm"
HALF_WIDTH = 31.0  # um, of the cut
CUT = 1.05  # day, the end of the step in which cells are removed
BEYOND = 120.0  # um from the centre: lips near the surface, of a radius of 150

HEADER = ["growth", "relaxation time, day", "opening, µm", "of the diameter", "minutes"]


def cases():
    return [Case("cut, rim grows", {}, ("rim", "none")),
            Case("cut, rim grows and relaxes", {"Material/Relaxation time": "0.05"},
                 ("rim", "0.05")),
            Case("cut, core grows", {"Growth/Rate/Rate":
                                     "if(t < 0.99, 0.15*(1 - oxygen), 0)"}, ("core", "none"))]


def before_cut(run):  # the number of a state
    return int(numpy.flatnonzero(run.times < CUT - 1e-6)[-1])


def opening(run):
    """By how much the lips near the surface have moved apart from the last output
    before the cut to the end, um, and as a part of the diameter then."""
    first = before_cut(run)
    before = run.cells(first).set_index("id")
    lips = before[(before["X"] > BEYOND) & (abs(before["Z"]) < 50)
                  & (abs(before["Y"]) > HALF_WIDTH) & (abs(before["Y"]) < HALF_WIDTH + 11)]
    now = run.cells(-1).set_index("id").loc[lips.index]
    moved = 2 * (abs(now["y"]) - abs(lips["y"])).mean()
    rows = run.statistics
    return moved, moved / numpy.interp(run.times[first], rows["time"], rows["zmax"] - rows["zmin"])


def row(case, run):
    moved, part = opening(run)
    return [*case.values, f"{moved:+.1f}", f"{part:+.3f}"]


def draw(pairs):
    canvas, panels = plt.subplots(1, len(pairs), squeeze=False, layout="constrained",
                                  figsize=(3 * len(pairs), 3.2))
    for i, (axes, (case, run)) in enumerate(zip(panels[0], pairs)):
        left = run.cells(-1)["id"]
        for number, colour in ((before_cut(run), "#BBBBBB"), (-1, COLOURS[i])):
            cells = run.cells(number)
            shown = cells[cells["id"].isin(left) & (abs(cells["Z"]) < 9)]
            axes.plot(shown["x"], shown["y"], ".", markersize=3, color=colour)
        axes.set(aspect="equal", title=case.name.removeprefix("cut, "))
        axes.axis("off")
    return canvas
