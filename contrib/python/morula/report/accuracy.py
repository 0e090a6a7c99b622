# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How far the results of a run can be trusted: what its numbers say, and what
doc/accuracy-and-cost.md says of such a resolution."""
import math

import numpy as np
from morula.error_in_time import error_in_time

from . import markup
from .markup import definitions, number, paragraph

# Cells to a grid cell's edge, from the page's "Advice" and "Hard cases".
BEST, FEWEST, UNSAFE = (4.0, 7.0), 3.0, 2.0


def numbers(run):
    rows = run.statistics[1:]
    if not len(rows):
        return paragraph("No step has been done.")
    newton, linear = rows["newton_iterations"], rows["linear_iterations"]
    pairs = [
        ("largest residual at a step's end, relative to its first",
         number(rows["residual"].max()), "largest-residual"),
        ("Newton tolerance", run.keys["Solver/Newton tolerance"]),
        ("rejected steps", number(rows["rejected_steps"].sum()),
         "rejected-steps"),
        ("shortest step, day", number(rows["dt"].min())),
        ("Newton iterations a step: mean, most",
         f"{newton.mean():.3g}, {newton.max():.0f}", "newton-per-step"),
        ("linear iterations a Newton iteration",
         number(linear.sum() / max(1, newton.sum()))),
        ("grid spacing h, µm", run.keys["Grid/Spacing"]),
        ("cells to a grid cell's edge, first",
         f"{cells_per_edge(run, 0):.3g}", "cells-per-edge"),
        ("cells to a grid cell's edge, last",
         f"{cells_per_edge(run, -1):.3g}", "last-cells-per-edge"),
        ("elastic volume ratio, all steps",
         f"{rows['min_elastic_volume_ratio'].min():.3g} to "
         f"{rows['max_elastic_volume_ratio'].max():.3g}")]
    in_time = error_in_time(run.statistics)
    if in_time is not None:
        pairs.append(("error in time, its own estimate",
                      f"{100 * in_time:.2g} % of growth and strain",
                      "error-in-time"))
    file = run.directory / "condition.csv"
    if file.is_file():
        condition = np.atleast_1d(np.genfromtxt(
            file, delimiter=",", names=True))["condition"]
        pairs.append(("condition estimate, largest",
                      number(np.nanmax(condition))))
    return definitions(pairs)


def cells_per_edge(run, row):
    """h over the mean cell's edge, which is L_p at first; of the rows that
    have cells."""
    state = run.statistics[run.statistics["cells"] > 0].iloc[row]
    edge = (state["total_volume"] / state["cells"]) ** (1 / run.dimension)
    return run.number("Grid/Spacing") / edge


def notes(run):
    return markup.notes([*on_resolution(run), *on_shape(run), *on_fixed(run),
                         *on_steps(run), *on_strain(run)])


def on_resolution(run):
    least = min(cells_per_edge(run, 0), cells_per_edge(run, -1))
    there = f"There are at least {least:.3g} cells to a grid cell's edge"
    if least < UNSAFE:
        yield True, (f"{there}. Below two the energy is wrong by far "
                     "(doc/hard-cases.md).")
    elif least < FEWEST:
        yield True, (f"{there}. Fewer than three roughen the surface and "
                     "spoil the energy, and runs may fail.")
    elif least <= BEST[1]:
        yield False, (f"{there}; four to seven are best for a tissue that is "
                      "free or smooth.")
    else:
        yield False, (f"{there}. More than seven buy little: a finer grid is "
                      "worth more than finer cells where something is held.")


def on_shape(run):
    """The lattice against the sphere that it fills."""
    if (run.keys.get("Tissue/Shape") != "sphere"
            or run.keys.get("Tissue/Surface cells") == "trimmed"):
        return
    radius = run.number("Tissue/Radius")
    exact = (4 / 3 * math.pi * radius**3 if run.dimension == 3
             else math.pi * radius**2)
    excess = run.statistics["total_volume"][0] / exact - 1
    words = "more" if excess > 0 else "less"
    yield False, (f"The lattice of whole cells has {100 * abs(excess):.2f} % "
                  f"{words} volume than the sphere; Tissue/Surface cells = "
                  "trimmed removes that and costs nothing.")


def on_fixed(run):
    if not run.keys.get("Boundary conditions/Fixed where"):
        return
    h = run.number("Grid/Spacing")
    yield False, ("A part of the surface is held. Where such a part ends, the "
                  "solution is singular and the error falls with the first "
                  "power of h only: extreme values there mean nothing, and "
                  f"an energy belongs to its h, here {h:g} µm.")
    form = run.keys.get("Boundary conditions/Nitsche form", "symmetric")
    if form == "symmetric":
        yield True, ("This run has the symmetric form of Nitsche's method, "
                     "with which the mean energy of a half-held sphere is far "
                     "too high (doc/accuracy-and-cost.md). Method = consistent "
                     "(Nitsche form = unsymmetric with Nitsche penalty = 20) "
                     "takes away most of that for little time.")


def on_steps(run):
    rejected = int(run.statistics["rejected_steps"].sum())
    if rejected:
        yield True, (f"{rejected} steps were rejected and halved; log.txt "
                     "says why.")
    else:
        yield False, "No step was rejected."


def on_strain(run):
    rows = run.statistics
    low = rows["min_elastic_volume_ratio"].min()
    high = rows["max_elastic_volume_ratio"].max()
    if low < 0.5 or high > 2:
        yield True, (f"Some cell was squeezed or stretched to {low:.3g} to "
                     f"{high:.3g} times its grown volume: look where, and "
                     "whether a finer grid agrees.")
