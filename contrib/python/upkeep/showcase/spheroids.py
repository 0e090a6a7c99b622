# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tumour spheroids: series that were measured, Greenspan's equations (1972) fitted to
them, and runs of the scene with the same numbers.

    R² dR/dt = s/3 (R³ - max(R_n, R_i)³) - λ R_n³

The necrotic core R_n is where oxygen, used up at one rate wherever cells live, would
fall below what they need, from R² - 3 R_n² + 2 R_n³/R = R_c²; the arrested one R_i
where it falls below what growth needs, from R² + 2 R_n³/R - 2 R_n³/R_i - R_i² = R_d².
"""
from dataclasses import dataclass
from typing import NamedTuple

import numpy
import pandas
from morula.style import COLOURS, plt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from upkeep import ROOT

DATA = ROOT / "doc/data/spheroids.csv"
SCENE = ROOT / "prm/showcase/spheroid.prm"
DEATH = 0.2  # oxygen of the medium at which cells die, chosen
HEADER = ["series", "from the data, µm", "Greenspan's from the data, µm",
          "R from Greenspan's", "R_n from Greenspan's", "to day", "cells", "minutes"]


class Line(NamedTuple):
    """Of a cell line: radii of a spheroid in which necrosis and arrest begin, um;
    rates of growth, and a third of that at which the core fades, 1/day."""

    necrosis: float  # R_c
    arrest: float  # R_d
    growth: float  # s
    loss: float  # lambda


# Least squares of the radii to all series of a line, with an outer radius on the first
# day of each: by the number of cells seeded, um.
LINES = {"WM983b": Line(221.2, 187.2, 0.3684, 0.2336),
         "WM793b": Line(250.1, 202.3, 0.1668, 0.0481)}
STARTS = {"WM983b": {2500: 132.4, 10000: 194.9},
          "WM793b": {2500: 133.2, 5000: 176.8, 10000: 216.7}}


def necrotic_radius(outer, line):
    if outer <= line.necrosis:
        return 0.0
    return brentq(lambda r: outer**2 - 3 * r**2 + 2 * r**3 / outer - line.necrosis**2,
                  0, outer * (1 - 1e-9))


def arrested_radius(outer, necrotic, line):
    if necrotic == 0:
        return numpy.sqrt(max(0.0, outer**2 - line.arrest**2))

    def excess(r):
        return ((outer**2 + 2 * necrotic**3 / outer - line.arrest**2) * r - r**3
                - 2 * necrotic**3)
    if excess(necrotic) * excess(outer) >= 0:
        return necrotic
    return brentq(excess, necrotic, outer)


def radii(outer, line):
    """R, R_n, R_i of spheroids of these outer radii, um: three rows."""
    necrotic = [necrotic_radius(r, line) for r in outer]
    return numpy.array([outer, necrotic, [arrested_radius(r, n, line)
                                          for r, n in zip(outer, necrotic)]])


def course(start, days, line):
    """R, R_n, R_i on these days, um, from the outer radius on the first of them."""
    def rate(_, outer):
        _, necrotic, arrested = radii(outer, line)[:, 0]
        grown = outer**3 - max(necrotic, arrested)**3
        return (line.growth / 3 * grown - line.loss * necrotic**3) / outer**2
    solution = solve_ivp(rate, (days[0], days[-1]), [start], t_eval=days, rtol=1e-8,
                         max_step=0.2)
    return radii(solution.y[0], line)


@dataclass(frozen=True)
class Series:
    """Spheroids of a line that were seeded alike: days, the means of R, R_n, R_i on
    each, um, the standard deviation of R."""

    name: str
    line: Line
    start: float
    days: numpy.ndarray
    radii: numpy.ndarray
    deviation: numpy.ndarray

    def greenspan(self, days):
        return course(self.start, days, self.line)

    @property
    def keys(self):
        """All cells stand before their cycle at t = 0. As the growth of a cycle is
        linear in time, they are worth a volume that is 1/(2 ln² 2) = 1.0407 times
        theirs, once they are spread over the cycle: the mean of 1 + a over the steady
        ages a, whose density falls as 2^-a, by that of 2^a."""
        line = self.line
        arrest = 1 - (1 - DEATH) * (line.arrest / line.necrosis)**2
        radius = self.start * (2 * numpy.log(2)**2)**(1 / 3)
        return {"Time/End time": f"{self.days[-1] - self.days[0]:g}",
                "Tissue/Radius": f"{radius:.1f}",
                "Fields/oxygen/Diffusion": f"{line.necrosis}^2",
                "Growth/Rate/Rate":
                f"if(type == necrotic, {-3 * line.loss:.4f}, {line.growth}*"
                f"((oxygen > {arrest:.4f}) - (cycle_phase > 0 && cycle_phase < 9)))",
                "Proliferation/Cell cycle/Duration": f"{numpy.log(2) / line.growth:.4f}"}


def cases():
    table = pandas.read_csv(DATA, comment="#")
    found = []
    for line, starts in STARTS.items():
        for seeded, start in starts.items():
            rows = table[(table["cell_line"] == line) & (table["seeded_cells"] == seeded)]
            shares = rows[["necrotic_share_mean", "arrested_share_mean"]].to_numpy().T
            outer = rows["radius_mean_um"].to_numpy()
            found.append(Series(
                f"{line}, {seeded} cells", LINES[line], start, rows["day"].to_numpy(float),
                numpy.array([outer, *(outer * shares)]), rows["radius_sd_um"].to_numpy()))
    return found


def radii_of_run(run):
    """Times of a run, days, and R, R_n, R_i then, um: radii of balls of the volume
    that the surface encloses, of the necrotic cells, and of all cells that have too
    little oxygen to grow."""
    arrest = float(run.keys["Growth/Rate/Rate"].split("oxygen > ")[1].split(")")[0])
    volumes = []
    for i in range(len(run.times)):
        surface, cells = run.surface(i), run.cells(i)
        enclosed = sum(surface[x] * surface["n" + x] for x in "xyz")
        volumes.append([(enclosed * surface["area"]).sum() / 3,
                        cells["volume"][cells["type"] == 1].sum(),
                        cells["volume"][cells["oxygen"] <= arrest].sum()])
    return run.times, numpy.cbrt(3 * numpy.array(volumes).T / (4 * numpy.pi))


def row(series, run):
    """How far a run is from the data, and from the equations: there, the largest
    difference on any day after the first, as a part of their R."""
    times, found = radii_of_run(run)
    exact = series.greenspan(times + series.days[0])
    there = numpy.isin(times + series.days[0], series.days)
    data = numpy.isin(series.days, times + series.days[0])
    off = (abs(found - exact)[:, times > 0] / exact[0, times > 0]).max(axis=1)
    return [series.name, f"{rms(found[:, there] - series.radii[:, data]):.1f}",
            f"{rms((series.greenspan(series.days) - series.radii)[:, data]):.1f}",
            f"{100 * off[0]:.1f} %", f"{100 * off[1]:.1f} %",
            f"{times[-1] + series.days[0]:g}",
            f"{run.statistics['cells'].iloc[-1]:,.0f}"]


def rms(differences):
    return numpy.sqrt(numpy.mean(differences**2))


def draw(pairs):
    """Courses beside the data: a panel for each (series, its run)."""
    canvas, panels = plt.subplots(1, len(pairs), sharey=True, squeeze=False,
                                  figsize=(3.4 * len(pairs), 3.2), layout="constrained")
    for axes, (series, run) in zip(panels[0], pairs):
        times, found = radii_of_run(run)
        days = numpy.linspace(series.days[0], series.days[-1], 200)
        exact = series.greenspan(days)
        for i, name in enumerate(("outer radius", "necrotic core", "arrested core")):
            axes.errorbar(series.days, series.radii[i], fmt="o", markersize=4,
                          yerr=None if i else series.deviation, color=COLOURS[i],
                          linewidth=0.8)
            axes.plot(days, exact[i], ":", color=COLOURS[i])
            axes.plot(times + series.days[0], found[i], color=COLOURS[i], label=name)
        axes.set(title=series.name, xlabel="day after seeding")
    panels[0, 0].set_ylabel("radius, µm")
    panels[0, 0].legend(loc="upper left")
    return canvas
