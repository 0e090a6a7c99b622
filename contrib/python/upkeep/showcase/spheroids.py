# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tumour spheroids: series that were measured, Greenspan's equations (1972) fitted to
them, and runs of the scene with the same numbers.

    R² dR/dt = s/3 (R³ - max(R_n, R_i)³) - λ R_n³

The necrotic core R_n is where oxygen, used up at one rate wherever cells live, would
fall below what they need, from R² - 3 R_n² + 2 R_n³/R = R_c²; the arrested one R_i
where it falls below what growth needs, from R² + 2 R_n³/R - 2 R_n³/R_i - R_i² = R_d².
"""
from typing import NamedTuple

import numpy
import pandas
from morula.style import COLOURS, plt
from scipy.integrate import solve_ivp

from upkeep import ROOT

from . import Case

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
LINES = {"WM983b": Line(221.2, 187.2, 0.3684, 0.2336), "WM793b": Line(250.1, 202.3, 0.1668, 0.0481)}
STARTS = {"WM983b": {2500: 132.4, 10000: 194.9}, "WM793b": {2500: 133.2, 5000: 176.8, 10000: 216.7}}


def radii(outer, line):
    """R, R_n, R_i of spheroids of these outer radii, um: three rows. Both equations are
    cubic: of R_n the middle root, of R_i the largest one."""
    outer = numpy.asarray(outer, float)
    thin = numpy.minimum(1, line.necrosis / outer)**2
    necrotic = outer * (0.5 + numpy.cos((numpy.arccos(2 * thin - 1) - 2 * numpy.pi) / 3))
    square = numpy.maximum(outer**2 + 2 * necrotic**3 / outer - line.arrest**2, 1e-12)
    angle = numpy.arccos(numpy.maximum(-necrotic**3 * (3 / square)**1.5, -1))
    return numpy.array([outer, necrotic, 2 * numpy.sqrt(square / 3) * numpy.cos(angle / 3)])


def course(start, days, line):
    """R, R_n, R_i on these days, um, from the outer radius on the first of them."""
    def rate(_, outer):
        _, necrotic, arrested = radii(outer, line)[:, 0]
        grown = outer**3 - max(necrotic, arrested)**3
        return (line.growth / 3 * grown - line.loss * necrotic**3) / outer**2
    solution = solve_ivp(rate, (days[0], days[-1]), [start], t_eval=days, rtol=1e-8, max_step=0.2)
    return radii(solution.y[0], line)


def keys(line, start, days):
    """All cells stand before their cycle at t = 0. As the growth of a cycle is linear in time, they
    are worth a volume that is 1/(2 ln² 2) = 1.0407 times theirs, once they are spread over the
    cycle: the mean of 1 + a over the steady ages a, whose density falls as 2^-a, by that of 2^a."""
    arrest = 1 - (1 - DEATH) * (line.arrest / line.necrosis)**2
    rate = (f"if(type == necrotic, {-3 * line.loss:.4f}, {line.growth}*"
            f"((oxygen > {arrest:.4f}) - (cycle_phase > 0 && cycle_phase < 9)))")
    return {"Time/End time": f"{days[-1] - days[0]:g}",
            "Tissue/Radius": f"{start * (2 * numpy.log(2)**2)**(1 / 3):.1f}",
            "Fields/oxygen/Diffusion": f"{line.necrosis}^2", "Growth/Rate/Rate": rate,
            "Proliferation/Cell cycle/Duration": f"{numpy.log(2) / line.growth:.4f}"}


def cases():
    """The values: line; outer radius at the start, um; days; the means of R, R_n, R_i on
    each, um; the standard deviation of R, um."""
    table = pandas.read_csv(DATA, comment="#").groupby(["cell_line", "seeded_cells"])
    found = []
    for line, seeded in ((line, seeded) for line in STARTS for seeded in STARTS[line]):
        rows, start = table.get_group((line, seeded)), STARTS[line][seeded]
        outer, days = rows["radius_mean_um"].to_numpy(), rows["day"].to_numpy(float)
        shares = rows[["necrotic_share_mean", "arrested_share_mean"]].to_numpy().T
        found.append(Case(
            f"{line}, {seeded} cells", keys(LINES[line], start, days),
            (LINES[line], start, days, numpy.array([outer, *(outer * shares)]),
             rows["radius_sd_um"].to_numpy())))
    return found


def radii_of_run(run):
    """Times, days, and R, R_n, R_i then, um: of balls of the volume that the surface
    encloses, of the necrotic cells, and of all that have too little oxygen to grow."""
    arrest = float(run.keys["Growth/Rate/Rate"].split("oxygen > ")[1].split(")")[0])
    volumes = []
    for i in range(len(run.times)):
        surface, cells = run.surface(i), run.cells(i)
        enclosed = sum(surface[x] * surface["n" + x] for x in "xyz")
        volumes.append([(enclosed * surface["area"]).sum() / 3,
                        cells["volume"][cells["type"] == 1].sum(),
                        cells["volume"][cells["oxygen"] <= arrest].sum()])
    return run.times, numpy.cbrt(3 * numpy.array(volumes).T / (4 * numpy.pi))


def row(case, run):
    """From the equations: the largest difference on any day, as a part of their R."""
    line, start, days, data, _ = case.values
    times, found = radii_of_run(run)
    exact = course(start, times + days[0], line)
    off = (abs(found - exact)[:, times > 0] / exact[0, times > 0]).max(axis=1)
    there, known = numpy.isin(times + days[0], days), numpy.isin(days, times + days[0])
    from_data = [numpy.sqrt(numpy.mean((some - data[:, known])**2)) for some in (
        found[:, there], course(start, days, line)[:, known])]
    return [case.name, *(f"{error:.1f}" for error in from_data),
            *(f"{100 * error:.1f} %" for error in off[:2]), f"{times[-1] + days[0]:g}",
            f"{run.statistics['cells'].iloc[-1]:,.0f}"]


def draw(pairs):
    canvas, panels = plt.subplots(1, len(pairs), sharey=True, squeeze=False,
                                  figsize=(3.4 * len(pairs), 3.2), layout="constrained")
    for axes, (case, run) in zip(panels[0], pairs):
        line, start, days, data, deviation = case.values
        fine = numpy.linspace(days[0], days[-1], 200)
        times, found = radii_of_run(run)
        exact = course(start, fine, line)
        for i, name in enumerate(("outer radius", "necrotic core", "arrested core")):
            axes.errorbar(days, data[i], fmt="o", markersize=4, color=COLOURS[i],
                          yerr=None if i else deviation, linewidth=0.8)
            axes.plot(fine, exact[i], ":", color=COLOURS[i])
            axes.plot(times + days[0], found[i], color=COLOURS[i], label=name)
        axes.set(title=case.name, xlabel="day after seeding")
    panels[0, 0].set_ylabel("radius, µm")
    panels[0, 0].legend(loc="upper left")
    return canvas
