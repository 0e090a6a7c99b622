# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the paper finds: each test returns whether our runs show it, and by what."""
import numpy as np
from morula import fits

from . import outline
from .catalogue import CHECKPOINTS, GRIDS

CURVES_END = 5.0  # days, of Fig. 4 (e-g); the run of (b) was continued beyond it
FROM_DAY = 2.0    # the fits' first day: by then the checkpoint has acted
FROM_RATIO = 2.0  # cells over founders: before, most divide together


def grids(runs):
    """The yardstick is a cell's size: a coarse outline that is a cell off."""
    size = runs["fig-2b"].number("Tissue/Cell spacing")
    fine = outline.profile(runs["fig-2e"], -1)
    near, away = {}, {}
    for scene in GRIDS[:4]:
        near[scene], away[scene] = map(outline.rms, outline.distances(runs[scene], -1, fine))
    return all((near[scene] < size) == (scene in ("fig-2a", "fig-2b")) for scene in near), (
        "rms distance from the outline of (e) near the clamp, in µm: "
        + listed(near, "{:.1f}") + f"; agreement is less than the size of a cell, {size:g} µm; "
        "away from the clamp: " + listed(away, "{:.1f}"))


def listed(values, form):
    return ", ".join(f"{form.format(value)} ({scene[-1]})" for scene, value in values.items())


def close_to_fits(runs, columns, fit):
    """By the largest relative distance of each column of Fig. 3 (c-e) from its fit."""
    rows, off = runs["fig-3b"].statistics, []
    for column in columns:
        function = fit(rows["time"], rows[column])
        time, values = fits.in_range(rows["time"], rows[column], fits.RANGE)
        off.append(np.max(np.abs(values / function(time) - 1)))
    return max(off) < 0.02, "largest distance from the fit over 2 ≤ t ≤ 4 days: " + " and ".join(
        f"{100 * part:.1f} %" for part in off)


def halves(run):
    """The cells that Fig. 4 (a-d) shows, below and above the clamp's edge."""
    growing = run.keys["Proliferation/Law"] == "none"
    cells = run.cells(-1 if growing else run.picture_state)
    low = cells["z"] < float(run.keys["Tissue/Center"].split(",")[2])
    return cells[low], cells[~low]


def means(run, column):
    return [float(half[column].mean()) for half in halves(run)]


def large_cells_above(runs):
    run = runs["fig-4c"]
    limit = 2 * run.number("Tissue/Cell spacing")**3
    low, high = (int((half["volume"] > limit).sum()) for half in halves(run))
    above = high / max(1, low + high)
    return above > 0.99, (f"{100 * above:.1f} % of the {low + high:,} cells of more than twice a "
                          "founder's initial volume are above the clamp's edge")


def suppressed_below(runs):
    with_it, without = (means(runs[scene], "generation") for scene in ("fig-4b", "fig-4c"))
    return with_it[0] < 0.75 * with_it[1] and abs(without[0] / without[1] - 1) < 0.1, (
        f"mean generation below and above: {with_it[0]:.2f}, {with_it[1]:.2f} with, "
        f"{without[0]:.2f}, {without[1]:.2f} without")


def energy_accumulates(runs):
    with_it, without, grown = found = [means(runs[scene], "energy_density")
                                       for scene in ("fig-4b", "fig-4c", "fig-4d")]
    return with_it[0] < without[0] and without[0] > without[1] and grown[0] > grown[1], (
        "mean Ψ_p in kPa below and above: " + ", ".join(
            f"{low:.3f}, {high:.3f} ({letter})" for letter, (low, high) in zip("bcd", found)))


def different_shapes(runs):
    with_it, without = runs["fig-4b"], runs["fig-4c"]
    near, away = map(outline.rms, outline.distances(
        without, without.picture_state, outline.profile(with_it, with_it.picture_state)))
    size = with_it.number("Tissue/Cell spacing")
    return max(near, away) > size, (
        "rms distance of the outline without checkpoint from that with it: "
        f"{near:.1f} µm near the clamp, {away:.1f} µm away from it; a cell's size is {size:g} µm")


def five_days(run):
    """The statistics up to the end of the curves."""
    return run.statistics[run.statistics["time"] <= CURVES_END + 1e-6]


def by_checkpoint(runs, values, form):
    """A value for each of the five checkpoints, as text."""
    names = [f"J_th {runs[scene].threshold:g}" if runs[scene].threshold else "none"
             for scene in CHECKPOINTS]
    return ", ".join(f"{form.format(value)} ({name})" for value, name in zip(values, names))


def slower(runs):
    """N_p(t) of each J_th below that of the next smaller one."""
    series = [five_days(runs[scene]) for scene in CHECKPOINTS]
    ordered = True
    for a, b in zip(series, series[1:]):
        late = b[b["time"] >= FROM_DAY - 1e-6]
        ordered &= bool((late["cells"] < np.interp(late["time"], a["time"], a["cells"])).all())
    return ordered, f"at every step end from day {FROM_DAY:g}; last N_p: " + by_checkpoint(
        runs, [rows["cells"].iloc[-1] for rows in series], "{:,.0f}")


def at_equal_number(runs, column, sign, scale, unit, form):
    """Whether a column, at equal numbers of cells, increases with J_th (sign 1; -1: decreases) for
    each pair of neighbours, and its values at the largest number that all reach."""
    series = [five_days(runs[scene]) for scene in CHECKPOINTS]
    founders = series[0]["cells"].iloc[0]
    ordered = True
    for a, b in zip(series, series[1:]):
        end = min(a["cells"].iloc[-1], b["cells"].iloc[-1])
        numbers = np.linspace(min(FROM_RATIO * founders, end), end, 50)
        before, after = (np.interp(numbers, rows["cells"], rows[column]) for rows in (a, b))
        ordered &= bool((sign * (after - before) > 0).all())
    common = min(rows["cells"].iloc[-1] for rows in series)
    values = [scale * np.interp(common, rows["cells"], rows[column]) for rows in series]
    return ordered, (f"for every N_p above {FROM_RATIO:g} times the founders; at N_p = "
                     f"{common:,.0f} in {unit}: " + by_checkpoint(runs, values, form))


# (where, what the paper finds, scenes, test) in the paper's order.
FINDINGS = (
    ("§2.5, Fig. 2", "33 and 50 µm agree with the fine reference, 75 and 100 µm are distorted "
     "near the clamp", GRIDS, grids),
    ("§3.1, Fig. 3 c, d", "N_p and V_tot increase exponentially", ("fig-3b",),
     lambda runs: close_to_fits(runs, ("cells", "total_volume"), fits.fit_exponential)),
    ("§3.1, Fig. 3 e", "Ψ_ave increases linearly", ("fig-3b",),
     lambda runs: close_to_fits(runs, ("mean_energy_density",), fits.fit_line)),
    ("§3.2, Fig. 4 a", "cells with relatively large V_p only in the upper half", ("fig-4c",),
     large_cells_above),
    ("§3.2, Fig. 4 b, c", "with the checkpoint the lower half proliferates less, without it "
     "both halves do alike", ("fig-4b", "fig-4c"), suppressed_below),
    ("§3.2, Fig. 4 b-d", "without the checkpoint energy accumulates, mostly in the lower half; "
     "less with it; growth by θ accumulates it in the lower half",
     ("fig-4b", "fig-4c", "fig-4d"), energy_accumulates),
    ("§3.2, Fig. 4 b, c", "with equal N_p the tissues have different shapes",
     ("fig-4b", "fig-4c"), different_shapes),
    ("§3.2, Fig. 4 e", "the larger J_th, the slower N_p increases", CHECKPOINTS, slower),
    ("§3.2, Fig. 4 f", "at equal N_p, the larger J_th, the larger V_tot", CHECKPOINTS,
     lambda runs: at_equal_number(runs, "total_volume", 1, 1e-6, "10⁶ µm³", "{:.1f}")),
    ("§3.2, Fig. 4 g", "at equal N_p, the larger J_th, the smaller Ψ_ave", CHECKPOINTS,
     lambda runs: at_equal_number(runs, "mean_energy_density", -1, 1, "kPa", "{:.3f}")),
)


def row(runs, place, claim, scenes, test):
    """The fields of the table, as text."""
    missing = runs.lacking(scenes)
    if missing:
        return place, claim, "", "not run", "", "missing: " + ", ".join(missing)
    try:
        holds, evidence = test(runs)
    except (fits.NothingToFit, ValueError) as error:
        return place, claim, "", "not tested", "", str(error)
    return place, claim, "", "holds" if holds else "**does not hold**", "", evidence
