# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the paper finds, tested on our runs."""
from dataclasses import dataclass

import numpy as np
from morula import fits

from . import figure_4, outline
from .catalogue import CHECKPOINTS, GRIDS


@dataclass(frozen=True)
class Finding:
    """A claim of the paper, whether the runs show it, and by what."""

    place: str
    claim: str
    holds: bool
    evidence: str


# Fig. 2

ACCURATE, DISTORTED = ("fig-2a", "fig-2b"), ("fig-2c", "fig-2d")


def distances(runs, reference=None):
    """Of the surfaces of Fig. 2 (a-d) from the outline of (e), or of all five
    from another outline."""
    fine = runs["fig-2e"]
    time = fine.last_output
    others = [scene for scene in GRIDS if reference or scene != "fig-2e"]
    reference = reference or outline.profile(fine, time)
    return {scene: outline.distance(runs[scene], time, reference)
            for scene in others}


def grids(runs):
    """The yardstick is a cell's size: a coarse outline that is a cell off."""
    size = runs["fig-2b"].number("Tissue/Cell spacing")
    found = distances(runs)
    near = {scene: values.near_rms for scene, values in found.items()}
    return Finding(
        "§2.5, Fig. 2", "33 and 50 µm agree with the fine reference, 75 and "
        "100 µm are distorted near the clamp",
        all(near[scene] < size for scene in ACCURATE) and
        all(near[scene] > size for scene in DISTORTED),
        "rms distance from the outline of (e) near the clamp, in µm: " +
        ", ".join(f"{near[scene]:.1f} ({scene[-1]})" for scene in near) +
        f"; agreement is less than the size of a cell, {size:g} µm; away from "
        "the clamp: " + ", ".join(f"{values.away_rms:.1f} ({scene[-1]})"
                                  for scene, values in found.items()))


# Fig. 3

def exponential_growth(runs):
    rows = runs["fig-3b"].statistics
    time = rows["time"]
    quality = [deviation(fits.fit_exponential(time, rows[name]), time,
                         rows[name]) for name in ("cells", "total_volume")]
    return Finding(
        "§3.1, Fig. 3 c, d", "N_p and V_tot increase exponentially",
        max(quality) < 0.02, "largest distance from the fit over 2 ≤ t ≤ 4 "
        f"days: {100 * quality[0]:.1f} % and {100 * quality[1]:.1f} %")


def linear_energy(runs):
    rows = runs["fig-3b"].statistics
    name = "mean_energy_density"
    quality = deviation(fits.fit_line(rows["time"], rows[name]), rows["time"],
                        rows[name])
    return Finding("§3.1, Fig. 3 e", "Ψ_ave increases linearly",
                   quality < 0.02, "largest distance from the fit over "
                   f"2 ≤ t ≤ 4 days: {100 * quality:.1f} %")


def deviation(function, time, values):
    """Largest relative distance of the values from a fitted function."""
    time, values = fits.in_range(time, values, fits.RANGE)
    return float(np.max(np.abs(values / function(time) - 1)))


# Fig. 4 (a-d)

def state_shown(run):
    """The cells of Fig. 4 and which of them are below the clamp's edge."""
    time = (run.last_output if run.keys["Proliferation/Law"] == "none" else
            figure_4.picture_time(run))
    positions, columns = run.read("cells", time)
    edge = float(run.keys["Tissue/Center"].split(",")[2])
    return columns, positions[:, 2] < edge


def halves(run, field):
    """Mean of a field over the cells below and above the clamp's edge."""
    columns, low = state_shown(run)
    return float(columns[field][low].mean()), float(columns[field][~low].mean())


def large_cells_above(runs):
    run = runs["fig-4c"]
    columns, low = state_shown(run)
    limit = 2 * run.number("Tissue/Cell spacing")**3
    large = columns["volume"] > limit
    above = (large & ~low).sum() / max(1, large.sum())
    return Finding(
        "§3.2, Fig. 4 a", "cells with relatively large V_p only in the upper "
        "half", bool(large.any() and above > 0.99),
        f"{100 * above:.1f} % of the {large.sum():,} cells of more than twice "
        "a founder's initial volume are above the clamp's edge")


def suppressed_below(runs):
    with_it = halves(runs["fig-4b"], "generation")
    without = halves(runs["fig-4c"], "generation")
    return Finding(
        "§3.2, Fig. 4 b, c", "with the checkpoint the lower half proliferates "
        "less, without it both halves do alike",
        with_it[0] < 0.75 * with_it[1] and
        abs(without[0] / without[1] - 1) < 0.1,
        "mean generation below and above: "
        f"{with_it[0]:.2f}, {with_it[1]:.2f} with, "
        f"{without[0]:.2f}, {without[1]:.2f} without")


def energy_accumulates(runs):
    found = {scene: halves(runs[scene], "energy_density")
             for scene in ("fig-4b", "fig-4c", "fig-4d")}
    with_it, without, hypertrophy = found.values()
    return Finding(
        "§3.2, Fig. 4 b-d", "without the checkpoint energy accumulates, mostly "
        "in the lower half; less with it; growth by θ accumulates it in the "
        "lower half",
        with_it[0] < without[0] and without[0] > without[1] and
        hypertrophy[0] > hypertrophy[1],
        "mean Ψ_p in kPa below and above: " + ", ".join(
            f"{low:.3f}, {high:.3f} ({scene[-1]})"
            for scene, (low, high) in found.items()))


def different_shapes(runs):
    with_it, without = runs["fig-4b"], runs["fig-4c"]
    apart = outline.distance(
        without, figure_4.picture_time(without),
        outline.profile(with_it, figure_4.picture_time(with_it)))
    size = with_it.number("Tissue/Cell spacing")
    return Finding(
        "§3.2, Fig. 4 b, c", "with equal N_p the tissues have different shapes",
        max(apart.near_rms, apart.away_rms) > size,
        "rms distance of the outline without checkpoint from that with it: "
        f"{apart.near_rms:.1f} µm near the clamp, {apart.away_rms:.1f} µm away "
        f"from it; a cell's size is {size:g} µm")


# Fig. 4 (e-g)

FROM_DAY = 2.0  # the fits' first day: by then the checkpoint has acted
FROM_RATIO = 2.0  # cells over founders: before, most divide together


def slower(runs):
    """N_p(t) of each J_th below that of the next smaller one."""
    series = [figure_4.five_days(runs[scene]) for scene in CHECKPOINTS]
    ordered = all(
        np.all(b["cells"][b["time"] >= FROM_DAY - 1e-6] <
               np.interp(b["time"][b["time"] >= FROM_DAY - 1e-6], a["time"],
                         a["cells"])) for a, b in zip(series, series[1:]))
    return Finding(
        "§3.2, Fig. 4 e", "the larger J_th, the slower N_p increases", ordered,
        f"at every step end from day {FROM_DAY:g}; last N_p: " + ", ".join(
            f"{rows['cells'].iloc[-1]:,.0f} ({threshold(runs, scene)})"
            for scene, rows in zip(CHECKPOINTS, series)))


def threshold(runs, scene):
    value = figure_4.threshold(runs[scene])
    return f"J_th {value:g}" if value else "none"


def at_equal_number(runs, column, larger):
    """Whether a column, at equal numbers of cells, increases (or decreases)
    with J_th for each pair of neighbours, and the values at the largest
    number that all reach."""
    series = [figure_4.five_days(runs[scene]) for scene in CHECKPOINTS]
    founders = series[0]["cells"].iloc[0]
    ordered = True
    for a, b in zip(series, series[1:]):
        end = min(a["cells"].iloc[-1], b["cells"].iloc[-1])
        places = np.linspace(min(FROM_RATIO * founders, end), end, 50)
        difference = (np.interp(places, b["cells"], b[column]) -
                      np.interp(places, a["cells"], a[column]))
        ordered &= bool(np.all(difference > 0 if larger else difference < 0))
    common = min(rows["cells"].iloc[-1] for rows in series)
    return ordered, common, [float(np.interp(common, rows["cells"],
                                             rows[column])) for rows in series]


def larger_volume(runs):
    ordered, common, values = at_equal_number(runs, "total_volume", True)
    return Finding(
        "§3.2, Fig. 4 f", "at equal N_p, the larger J_th, the larger V_tot",
        ordered, f"for every N_p above {FROM_RATIO:g} times the founders; at "
        f"N_p = {common:,.0f} in 10⁶ µm³: " + ", ".join(
            f"{value * 1e-6:.1f} ({threshold(runs, scene)})"
            for scene, value in zip(CHECKPOINTS, values)))


def smaller_energy(runs):
    ordered, common, values = at_equal_number(runs, "mean_energy_density",
                                              False)
    return Finding(
        "§3.2, Fig. 4 g", "at equal N_p, the larger J_th, the smaller Ψ_ave",
        ordered, f"for every N_p above {FROM_RATIO:g} times the founders; at "
        f"N_p = {common:,.0f} in kPa: " + ", ".join(
            f"{value:.3f} ({threshold(runs, scene)})"
            for scene, value in zip(CHECKPOINTS, values)))


# (scenes, function) in the paper's order.
FINDINGS = (
    (GRIDS, grids),
    (("fig-3b",), exponential_growth),
    (("fig-3b",), linear_energy),
    (("fig-4c",), large_cells_above),
    (("fig-4b", "fig-4c"), suppressed_below),
    (("fig-4b", "fig-4c", "fig-4d"), energy_accumulates),
    (("fig-4b", "fig-4c"), different_shapes),
    (CHECKPOINTS, slower),
    (CHECKPOINTS, larger_volume),
    (CHECKPOINTS, smaller_energy),
)
