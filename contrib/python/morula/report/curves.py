# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The columns of statistics.csv over time, as pictures."""
from dataclasses import dataclass

import numpy as np
from morula.fits import RANGE
from morula.style import COLOURS
from scipy.stats import linregress

from .numbers import number, volume_unit
from .pictures import drawn

LEAST_ROWS = 5
LEAST_GROWTH = 1.02  # last over first value in the range of a fit
LEAST_R2 = 0.99


@dataclass(frozen=True)
class Curve:
    """Columns drawn together; the column `grown` may be exponential."""

    title: str
    unit: str
    columns: dict
    grown: str = ""
    log: bool = False
    zero: bool = False  # the axis begins at zero
    only_steps: bool = False  # not of the initial state


def results(run):
    rows, volume = run.statistics, volume_unit(run)
    yield Curve("Number of cells", "", {"cells": "cells"}, grown="cells")
    of_types = {f"cells_{name}": name for name in run.type_names}
    if of_types and {*of_types} <= {*rows}:
        yield Curve("Cells of each type", "", of_types, zero=True)
    yield Curve("Volume", volume, {
        "total_volume": "of the cells, deformed",
        "grown_volume": "of the cells, were they free"}, grown="total_volume")
    yield Curve("Strain energy density", "kPa", {
        "mean_energy_density": "mean, weighted by volume",
        "cell_mean_energy_density": "mean, each cell once"})
    yield Curve("Largest strain energy density", "kPa", {"max_energy_density": "largest"})
    yield Curve("Elastic volume ratio", "", {"min_elastic_volume_ratio": "smallest",
                                             "max_elastic_volume_ratio": "largest"})
    if rows["dividing"].any():
        yield Curve("Divisions in a step", "", {"dividing": "divisions"}, only_steps=True)
    if rows["held_at_checkpoint"].any():
        yield Curve("Cells that wait at the size checkpoint", "", {"held_at_checkpoint": "waiting"})
    if "dying" in rows:
        yield Curve("Dead cells that are still there", "", {"dying": "dead cells"})
        yield Curve("Deaths and removals in a step", "",
                    {"deaths": "deaths", "removed": "removals"}, only_steps=True)
    for name in run.field_names:
        yield Curve(f"The field {name}", "", {
            f"{name}_max": "largest", f"{name}_mean": "mean, by volume",
            f"{name}_min": "least"}, zero=True)
    yield Curve("Extent of the surface", "µm", {
        f"{axis}{end}": f"{axis}, {word}" for axis in "xyz"[:run.dimension]
        for end, word in (("min", "least"), ("max", "most"))})


def effort(run):
    yield Curve("Unknowns", "", {"unknowns": "unknowns"}, only_steps=True, zero=True)
    yield Curve("Iterations in a step", "", {
        "linear_iterations": "linear", "newton_iterations": "Newton"},
        only_steps=True, zero=True)
    yield Curve("Wall time", "s", {"wall_seconds": "since the start"})
    yield Curve("Last residual of a step, relative", "", {"residual": "residual"},
                only_steps=True, log=True)
    yield Curve("Length of a step", "day", {"dt": "step"}, only_steps=True, zero=True)
    if "step_error" in run.statistics:
        yield Curve("Error in time of growth and strain so far, its own estimate", "",
                    {"step_error": "error"}, only_steps=True, zero=True)


def figures(run, curves):
    """(title, picture, words with the last values and the fit)"""
    for curve in curves:
        rows = run.statistics[1:] if curve.only_steps else run.statistics
        if not len(rows):
            continue
        last = rows.iloc[-1]
        fit = curve.grown and fit_growth(rows["time"], rows[curve.grown])
        words = "; ".join(f"{label}: {number(last[name])} {curve.unit}".strip()
                          for name, label in curve.columns.items())
        yield (", ".join(filter(None, (curve.title, curve.unit))), picture(rows, curve, fit),
               f"Day {last['time']:g}: {words}. {fit.words if fit else ''}")


def picture(rows, curve, fit):
    def draw(axes):
        for i, (name, label) in enumerate(curve.columns.items()):
            # a name is no formula, whatever dollars stand in it
            axes.plot(rows["time"], rows[name], label=label.replace("$", r"\$"),
                      linestyle="-" if i < len(COLOURS) else ":")
        if fit and fit.exponential:
            time = np.linspace(fit.low, fit.high, 100)
            axes.plot(time, fit.factor * np.exp(fit.rate * time), "k--", label="exponential fit")
        if curve.log and (rows[[*curve.columns]] > 0).any(axis=None):
            axes.set_yscale("log")
        if curve.zero:
            axes.set_ylim(bottom=0)
        axes.set_xlabel("day")
        axes.legend()
    return drawn(draw)


@dataclass(frozen=True)
class Fit:
    """factor · e^{rate t} over a range of days, with the coefficients of
    determination of the logarithm and, to compare, of a straight line."""

    factor: float
    rate: float
    low: float
    high: float
    rows: int
    r2: float
    r2_line: float

    @property
    def exponential(self):
        """Whether the curve may be called so: the fit explains nearly
        everything, and more than a straight line does."""
        return self.r2 >= LEAST_R2 and self.r2 >= self.r2_line

    @property
    def words(self):
        where = f"days {self.low:g} to {self.high:g} ({self.rows} steps)"
        found = (f"Fit over {where}: {self.factor:.4g} · exp({self.rate:.4f} t/day)"
                 if self.exponential else f"Not exponential over {where}")
        return f"{found}, r² = {self.r2:.5f}; of a straight line r² = {self.r2_line:.5f}."


def fit_growth(time, values):
    """By least squares of the logarithm over days 2 to 4 as in the paper's
    Figs. 3 and 4, or over the second half of a run that has not come so far; None
    where there are too few rows or nothing grows."""
    time, values = np.asarray(time), np.asarray(values, dtype=float)
    low, high = RANGE
    if time[-1] < high - 1e-6:
        low, high = 0.5 * (time[0] + time[-1]), time[-1]
    kept = (time >= low - 1e-6) & (time <= high + 1e-6)
    t, v = time[kept], values[kept]
    if len(t) < LEAST_ROWS or not min(v) > 0 or v[-1] < LEAST_GROWTH * v[0]:
        return None
    growth = linregress(t, np.log(v))
    return Fit(float(np.exp(growth.intercept)), float(growth.slope), float(low), float(high),
               len(t), growth.rvalue**2, linregress(t, v).rvalue**2)
