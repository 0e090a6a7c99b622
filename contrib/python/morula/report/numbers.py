# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Lists of (name, value): the run at a glance, its cost, how far its results can be trusted."""
import numpy as np
from morula.error_in_time import error_in_time

# Cells to a grid cell's edge: doc/accuracy-and-cost.md, Advice.
FEWEST, UNSAFE = 3.0, 2.0


def number(value):
    """Four digits; whole and large numbers with separated thousands."""
    value = float(value)
    if abs(value) < 1e15 and (abs(value) >= 1e5 or value == int(value)):
        return f"{value:,.0f}"
    return f"{value:.4g}"


def volume_unit(run):
    return "µm³" if run.dimension == 3 else "µm²"


def at_a_glance(run):
    first, last = run.statistics.iloc[0], run.statistics.iloc[-1]
    return [("from day", number(first["time"])), ("to day", number(last["time"])),
            ("steps", number(len(run.statistics) - 1)),
            ("cells at first", number(first["cells"])),
            ("cells at last", number(last["cells"])),
            (f"volume at last, {volume_unit(run)}", number(last["total_volume"])),
            ("wall time, s", number(last["wall_seconds"]))]


def work(run):
    rows = run.statistics[1:]
    if not len(rows):
        return []
    seconds = np.diff(run.statistics["wall_seconds"])
    wall = rows["wall_seconds"].iloc[-1]
    return [("unknowns, most", number(rows["unknowns"].max())),
            ("active grid cells, most", number(rows["active_grid_cells"].max())),
            ("inner splines, last", number(rows["inner_splines"].iloc[-1])),
            ("outer splines, last", number(rows["outer_splines"].iloc[-1])),
            ("Newton iterations", number(rows["newton_iterations"].sum())),
            ("linear iterations", number(rows["linear_iterations"].sum())),
            ("cell-steps a second of wall time",
             number(round(rows["cells"].sum() / wall)) if wall > 0 else "–"),
            ("wall time of a step: median, longest, s",
             f"{np.median(seconds):.3g}, {seconds.max():.3g}")]


def timings(run):
    """Rows of timings.csv, longest first; what no section counts is the rest."""
    if "total" not in run.timings.index:
        return []
    calls, seconds, _ = run.timings.loc["total"]
    found = run.timings.drop("total").sort_values("wall_seconds", ascending=False)
    rest = seconds - found["wall_seconds"].sum()
    rows = [*found.itertuples(name=None), ("all else", calls, rest, rest / seconds),
            ("total", calls, seconds, 1.0)]
    return [(name, number(n), f"{s:.2f}", f"{100 * share:.1f} %") for name, n, s, share in rows]


def accuracy(run):
    rows = run.statistics[1:]
    if not len(rows):
        return []
    newton, linear = rows["newton_iterations"], rows["linear_iterations"]
    in_time = error_in_time(run.statistics)
    found = [
        ("largest residual at a step's end, relative to its first",
         number(rows["residual"].max())),
        ("Newton tolerance", run.keys["Solver/Newton tolerance"]),
        ("rejected steps", number(rows["rejected_steps"].sum())),
        ("shortest step, day", number(rows["dt"].min())),
        ("Newton iterations a step: mean, most",
         f"{newton.mean():.3g}, {newton.max():.0f}"),
        ("linear iterations a Newton iteration",
         number(linear.sum() / max(1, newton.sum()))),
        ("grid spacing h, µm", run.keys["Grid/Spacing"]),
        ("cells to a grid cell's edge, first", f"{cells_per_edge(run, 0):.3g}"),
        ("cells to a grid cell's edge, last", f"{cells_per_edge(run, -1):.3g}"),
        ("elastic volume ratio, all steps",
         f"{rows['min_elastic_volume_ratio'].min():.3g} to "
         f"{rows['max_elastic_volume_ratio'].max():.3g}"),
        ("error in time, its own estimate", "none to estimate" if in_time is None
         else f"{100 * in_time:.2g} % of growth and strain"),
        ("condition estimate, largest", condition(run))]
    return [(name, value) for name, value in found if value]


def errors(run):
    """The error bars that morula accuracy has kept."""
    return [(name, row.text.partition(" = ")[2]) for name, row in run.errors.iterrows()]


def condition(run):
    file = run.directory / "condition.csv"
    if not file.is_file():
        return None
    table = np.genfromtxt(file, delimiter=",", names=True)
    return number(np.nanmax(table["condition"]))


def cells_per_edge(run, row):
    """h over the mean cell's edge, which is L_p at first; of the rows that have cells."""
    state = run.statistics[run.statistics["cells"] > 0].iloc[row]
    edge = (state["total_volume"] / state["cells"]) ** (1 / run.dimension)
    return run.number("Grid/Spacing") / edge


def warnings(run):
    least = min(cells_per_edge(run, 0), cells_per_edge(run, -1))
    if least < FEWEST:
        yield (f"There are only {least:.3g} cells to a grid cell's edge: " + (
            "the energy is wrong by far." if least < UNSAFE else
            "the surface is rough, the energy is inaccurate, and runs may fail."))
    if (run.keys.get("Boundary conditions/Fixed where") and
            run.keys.get("Boundary conditions/Nitsche form", "symmetric") == "symmetric"):
        yield ("The symmetric form of Nitsche's method overestimates the energy at the edge "
               "of a fixed surface. Method = consistent mostly removes this.")
    rejected = int(run.statistics["rejected_steps"].sum())
    if rejected:
        yield f"{rejected} steps were rejected and halved; log.txt says why."
    low = run.statistics["min_elastic_volume_ratio"].min()
    high = run.statistics["max_elastic_volume_ratio"].max()
    if low < 0.5 or high > 2:
        yield (f"Some cell was squeezed or stretched to {low:.3g} to {high:.3g} times its "
               "grown volume: look where, and whether a finer grid agrees.")
