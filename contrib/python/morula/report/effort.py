# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where the time went, and how much work was done."""
import numpy as np

from .markup import definitions, number, paragraph, span, table


def timings(run):
    """timings.csv with bars, longest first; what no section counts is the
    rest."""
    found = run.timings
    if "total" not in found.index:
        return paragraph("There is no timings.csv: it is written when a run "
                         "ends.")
    calls, seconds, _ = found.loc["total"]
    found = found.drop("total").sort_values("wall_seconds", ascending=False)
    rest = seconds - found["wall_seconds"].sum()
    rows = [*found.itertuples(name=None),
            ("all else", calls, rest, rest / seconds),
            ("total", calls, seconds, 1.0)]
    return table(["section", ">calls", ">seconds", ">share", ""], [
        (name, number(n), f"{s:.2f}", f"{100 * share:.1f} %", bar(share))
        for name, n, s, share in rows], "timings")


def bar(share):
    width = min(100.0, max(0.0, 100 * share))
    return span("bar", style=f"width:{width:.2f}%")


def counters(run):
    rows = run.statistics[1:]
    if not len(rows):
        return paragraph("No step has been done.")
    newton, linear = rows["newton_iterations"], rows["linear_iterations"]
    wall = rows["wall_seconds"].iloc[-1]
    return definitions([
        ("steps", number(len(rows))),
        ("unknowns, most", number(rows["unknowns"].max()), "most-unknowns"),
        ("active grid cells, most", number(rows["active_grid_cells"].max())),
        ("inner splines, last", number(rows["inner_splines"].iloc[-1])),
        ("outer splines, last", number(rows["outer_splines"].iloc[-1])),
        ("Newton iterations", number(newton.sum()), "newton"),
        ("linear iterations", number(linear.sum()), "linear"),
        ("cell-steps a second of wall time",
         number(round(rows["cells"].sum() / wall)) if wall > 0 else "–"),
        ("wall time of a step: median, longest, s",
         steps(np.diff(run.statistics["wall_seconds"])))])


def steps(seconds):
    return f"{np.median(seconds):.3g}, {seconds.max():.3g}"
