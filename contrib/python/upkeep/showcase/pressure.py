# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A spheroid under pressures that are held, and one that is released: the scene
of each, and what the law of growth alone says of it."""
from dataclasses import dataclass

import numpy
from morula.run import Run
from morula.style import COLOURS, RC, plt
from scipy.optimize import brentq

from .spheroids import ROOT

SCENE = ROOT / "prm/showcase/pressure.prm"

DOUBLING = 17 / 24  # days, of free CT26 (Van Liedekerke et al. 2019, Fig. 1)
QUIESCENT = 0.3  # of the free rate: below it nothing grows (their Fig. 3)
STOPPING = (6.0, 11.0, 16.0)  # kPa: 45 to 120 mmHg (Helmlinger et al. 1997)
CHOSEN = STOPPING[1]
MODULUS, RATIO = 10.0, 0.4  # E, kPa, and nu of the scene
RAMP, RELEASE = 0.1, 2.0  # days

HEADER = ["pressure, kPa", "growth rate, of the free one", "from J_e alone",
          "volume at the end, of the first", "from J_e alone", "cells",
          "minutes"]

plt.rcParams.update(RC)


def volume_ratio(pressure):
    """J_e of the neo-Hookean cells where all stress is this pressure, kPa."""
    shear = MODULUS / (2 * (1 + RATIO))
    lame_lambda = 2 * shear * RATIO / (1 - 2 * RATIO)

    def excess(J):
        return pressure + (lame_lambda * numpy.log(J)
                           + shear * (J**(2 / 3) - 1)) / J
    return brentq(excess, 0.2, 1.5, xtol=1e-14)


def half_strain(stopping=CHOSEN):
    """1 - J_e at which growth is half of the free one, if it stops at this
    pressure, kPa."""
    return (1 - volume_ratio(stopping)) * QUIESCENT / (1 - QUIESCENT)


def growth_rate(pressure, stopping=CHOSEN):
    """Under this pressure, kPa, over that of free tissue."""
    strain, half = 1 - volume_ratio(pressure), half_strain(stopping)
    rate = half / (half + strain)
    return rate if rate > QUIESCENT else 0.0


@dataclass(frozen=True)
class Case:
    """A pressure, kPa, held to the end or until RELEASE."""

    pressure: float
    released: bool = False

    @property
    def name(self):
        return (f"pressure {self.pressure:g} kPa"
                + (", released" if self.released else ""))

    def overrides(self):
        """What is special in the scene, as (key, value)."""
        if self.released:
            return ()  # the file's own
        return (("Boundary conditions/Pressure",
                 f"{self.pressure:g}*min(1, t/{RAMP:g})"),)

    def at(self, t):
        """Pressure at a time, kPa."""
        if self.released and t > RELEASE:
            return 0.0
        return self.pressure * min(1.0, t / RAMP)

    def course(self, days):
        """Volumes over the first, of tissue that has one J_e everywhere."""
        grown, last, volumes = 0.0, 0.0, []
        for day in days:
            nodes = numpy.linspace(last, day, 41)
            middles = (nodes[1:] + nodes[:-1]) / 2
            grown += (day - last) * numpy.mean(
                [growth_rate(self.at(t)) for t in middles])
            last = day
            volumes.append(2**(grown / DOUBLING)
                           * volume_ratio(self.at(day)))
        return numpy.array(volumes)


def all_cases():
    return [Case(0.0), Case(2.5), Case(5.0), Case(5.0, True), Case(10.0),
            Case(16.0)]


def found_rate(run):
    """Rate at which the grown volume rises between day 0.5 and RELEASE, over
    that of free tissue."""
    rows = run.statistics
    there = (rows["time"] > 0.5 - 1e-9) & (rows["time"] < RELEASE + 1e-9)
    slope = numpy.polyfit(rows["time"][there],
                          numpy.log(rows["grown_volume"][there]), 1)[0]
    return slope * DOUBLING / numpy.log(2)


def row(case, record):
    run = Run(record.output)
    rows = run.statistics
    volume = rows["total_volume"].iloc[-1] / rows["total_volume"].iloc[0]
    return [f"{case.pressure:g}" + (", released" if case.released else ""),
            f"{found_rate(run):.3f}", f"{growth_rate(case.pressure):.3f}",
            f"{volume:.2f}",
            f"{case.course(rows['time'].to_numpy())[-1]:.2f}",
            f"{rows['cells'].iloc[-1]:,.0f}",
            f"{record.process_seconds / 60:.1f}"]


def draw(pairs, path):
    """Courses of the volumes, and the rates over the pressure, of (case, record
    of its run)."""
    canvas, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.4),
                                         layout="constrained")
    for i, (case, record) in enumerate(pairs):
        run, shade = Run(record.output), COLOURS[i]
        rows = run.statistics
        left.semilogy(rows["time"], case.course(rows["time"].to_numpy()), ":",
                      color=shade)
        left.semilogy(rows["time"],
                      rows["total_volume"] / rows["total_volume"].iloc[0],
                      color=shade, label=case.name.removeprefix("pressure "))
        if not case.released:
            right.plot(case.pressure, found_rate(run), "o", color=shade)
    pressures = numpy.linspace(0, 18, 181)
    right.plot(pressures, [growth_rate(p) for p in pressures], ":",
               color="#444444", label=f"from J_e, stop at {CHOSEN:g} kPa")
    below = [growth_rate(p, STOPPING[0]) for p in pressures]
    above = [growth_rate(p, STOPPING[-1]) for p in pressures]
    right.fill_between(pressures, below, above, color="#444444", alpha=0.15,
                       linewidth=0, label=f"stop at {STOPPING[0]:g} to "
                       f"{STOPPING[-1]:g} kPa")
    left.set(xlabel="day", ylabel="volume, of the first")
    left.legend(loc="upper left")
    right.set(xlabel="pressure, kPa", ylabel="growth rate, of the free one",
              ylim=(0, None))
    right.legend(loc="upper right")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path)
    plt.close(canvas)
