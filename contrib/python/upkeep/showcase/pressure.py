# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A spheroid under pressures that are held, and one that is released: the scene
of each, and what the law of growth alone says of it."""
import numpy
from morula.style import COLOURS, plt
from scipy.optimize import brentq

from . import SCENES, Case

SCENE = SCENES / "pressure.prm"

DOUBLING = 17 / 24  # days, of free CT26 (Van Liedekerke et al. 2019, Fig. 1)
QUIESCENT = 0.3  # of the free rate: below it nothing grows (their Fig. 3)
STOPPING = (6.0, 11.0, 16.0)  # kPa: 45 to 120 mmHg (Helmlinger et al. 1997)
CHOSEN = STOPPING[1]
MODULUS, RATIO = 10.0, 0.4  # E, kPa, and nu of the scene
RAMP, RELEASE = 0.1, 2.0  # days

HEADER = ["pressure, kPa", "growth rate, of the free one", "from J_e alone",
          "volume at the end, of the first", "from J_e alone", "cells", "minutes"]


def volume_ratio(pressure):
    """J_e of the neo-Hookean cells where all stress is this pressure, kPa."""
    shear = MODULUS / (2 * (1 + RATIO))
    lame_lambda = 2 * shear * RATIO / (1 - 2 * RATIO)
    return brentq(lambda J: pressure + (lame_lambda * numpy.log(J) + shear * (J**(2 / 3) - 1)) / J,
                  0.2, 1.5, xtol=1e-14)


def half_strain(stopping=CHOSEN):
    """1 - J_e at which growth is half of the free one, if it stops at this pressure."""
    return (1 - volume_ratio(stopping)) * QUIESCENT / (1 - QUIESCENT)


def growth_rate(pressure, stopping=CHOSEN):
    """Under this pressure, kPa, over that of free tissue."""
    strain, half = 1 - volume_ratio(pressure), half_strain(stopping)
    rate = half / (half + strain)
    return rate if rate > QUIESCENT else 0.0


def course(pressure, release, days):
    """Volumes over the first, of tissue that has one J_e everywhere, under a pressure,
    kPa, to the day of the release."""
    def at(t):
        return pressure * min(1.0, t / RAMP) if t <= release else 0.0
    grown, last, volumes = 0.0, 0.0, []
    for day in days:
        nodes = numpy.linspace(last, day, 41)
        grown += (day - last) * numpy.mean(
            [growth_rate(at(t)) for t in (nodes[1:] + nodes[:-1]) / 2])
        last = day
        volumes.append(2**(grown / DOUBLING) * volume_ratio(at(day)))
    return numpy.array(volumes)


def cases():
    held = [Case(f"pressure {pressure:g} kPa", {"Boundary conditions/Pressure":
                 f"{pressure:g}*min(1, t/{RAMP:g})"}, (pressure, numpy.inf))
            for pressure in (0, 2.5, 5, 10, 16)]
    # the file's own
    return [*held[:3], Case("pressure 5 kPa, released", {}, (5, RELEASE)), *held[3:]]


def found_rate(run):
    """Rate at which the grown volume rises from day 0.5 to RELEASE, over the free one."""
    rows = run.statistics
    rows = rows[(rows["time"] > 0.5 - 1e-9) & (rows["time"] < RELEASE + 1e-9)]
    slope = numpy.polyfit(rows["time"], numpy.log(rows["grown_volume"]), 1)[0]
    return slope * DOUBLING / numpy.log(2)


def row(case, run):
    rows = run.statistics
    volume = rows["total_volume"].iloc[-1] / rows["total_volume"].iloc[0]
    return [case.name.removeprefix("pressure ").replace(" kPa", ""), f"{found_rate(run):.3f}",
            f"{growth_rate(case.values[0]):.3f}", f"{volume:.2f}",
            f"{course(*case.values, rows['time'])[-1]:.2f}", f"{rows['cells'].iloc[-1]:,.0f}"]


def draw(pairs):
    canvas, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.4), layout="constrained")
    for i, (case, run) in enumerate(pairs):
        rows = run.statistics
        left.semilogy(rows["time"], course(*case.values, rows["time"]), ":", color=COLOURS[i])
        left.semilogy(rows["time"], rows["total_volume"] / rows["total_volume"].iloc[0],
                      color=COLOURS[i], label=case.name.removeprefix("pressure "))
        if case.keys:
            right.plot(case.values[0], found_rate(run), "o", color=COLOURS[i])
    pressures = numpy.linspace(0, 18, 181)
    below, chosen, above = ([growth_rate(p, stopping) for p in pressures] for stopping in STOPPING)
    right.plot(pressures, chosen, ":", color="#444444", label=f"from J_e, stop at {CHOSEN:g} kPa")
    right.fill_between(pressures, below, above, color="#444444", alpha=0.15, linewidth=0,
                       label=f"stop at {STOPPING[0]:g} to {STOPPING[-1]:g} kPa")
    left.set(xlabel="day", ylabel="volume, of the first")
    left.legend(loc="upper left")
    right.set(xlabel="pressure, kPa", ylabel="growth rate, of the free one", ylim=(0, None))
    right.legend(loc="upper right")
    return canvas
