# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A growth plate that two morphogens regulate: the scene with different answers
of PTHrP to Ihh, and where the fields alone put the end of proliferation."""
from dataclasses import dataclass

import numpy
from morula.run import Run
from morula.style import COLOURS, RC, plt
from scipy.integrate import simpson
from scipy.optimize import brentq

from .spheroids import ROOT

SCENE = ROOT / "prm/showcase/growth-plate.prm"

REACH_IHH, REACH_PTHRP = 150.0, 100.0  # um, roots of D over the loss
ANSWER = 279.4  # of PTHrP to Ihh, 1/day
WALL = 50.0  # um from the wall, where cells answer
GROWTH = numpy.log(2) / 1.2875  # 1/day, of proliferating tissue
LONGER, LASTING = 2.44, 0.825  # hypertrophy: by which factor, in how many days
CUT, LEFT = 3.0, 150.0  # day, and height to which the zone is cut, um
PROLIFERATING, HYPERTROPHIC = 0, 1

HEADER = ["answer of PTHrP", "height, µm", "from the fields alone, µm",
          "growth, µm/day", "ln 2/T · height · 2.44", "days to come back",
          "from the height", "height at the end, µm", "minutes"]

plt.rcParams.update(RC)


def signal(height, answer):
    """PTHrP at the end of a proliferating zone of this height, um, below a thick
    layer of hypertrophic cells, which make Ihh at 1/day: steady fields before a
    wall at 0 that lets nothing through."""
    wall = numpy.linspace(0, WALL, 101)
    ihh = numpy.exp(-height / REACH_IHH) * numpy.cosh(wall / REACH_IHH)
    of_source = (numpy.exp(-(height - wall) / REACH_PTHRP)
                 + numpy.exp(-(height + wall) / REACH_PTHRP))
    return answer * simpson(of_source * ihh, x=wall) / (2 * REACH_PTHRP)


def steady_height(answer):
    """Where PTHrP is 1, um."""
    return brentq(lambda height: signal(height, answer) - 1, 20, 2000)


@dataclass(frozen=True)
class Case:
    """The scene with its answer times a factor."""

    factor: float

    @property
    def name(self):
        return f"growth plate, answer times {self.factor:g}"

    @property
    def answer(self):
        return self.factor * ANSWER

    def overrides(self):
        """What is special in the scene, as (key, value)."""
        if self.factor == 1:
            return ()  # the file's own
        return (("Fields/pthrp/Production",
                 f"{self.answer:g}*ihh*(y < {WALL:g})"),)


def all_cases():
    return [Case(1.0), Case(0.5), Case(2.0)]


def heights(directory):
    """Times of the output, and the height of the proliferating zone then: of as
    many of its cells as fill it over the whole width, um."""
    run = Run(directory)
    found = []
    for i in range(len(run.times)):
        cells = run.cells(i)
        y, kind = cells["y"], cells["type"]
        found.append((y[kind == PROLIFERATING].max()
                      + y[kind == HYPERTROPHIC].min()) / 2)
    return run.times, numpy.array(found)


def numbers(case, record):
    """Height before the cut, growth a day then, days until the zone has come
    back to 0.95 of it, height at the end."""
    times, height = heights(record.output)
    rows = Run(record.output).statistics
    steady = (times > 1.5) & (times < CUT - 1e-9)
    mean = height[steady].mean()
    there = (rows["time"] > 1.5) & (rows["time"] < CUT - 1e-9)
    speed = numpy.polyfit(rows["time"][there], rows["ymax"][there], 1)[0]
    after = times > CUT + 0.01
    back = times[after][height[after] >= 0.95 * mean]
    last = height[times > times[-1] - 0.55].mean()
    return mean, speed, back[0] - CUT if len(back) else numpy.nan, last


def row(case, record):
    mean, speed, back, last = numbers(case, record)
    return [f"{case.factor:g}", f"{mean:.0f}",
            f"{steady_height(case.answer):.0f}", f"{speed:.0f}",
            f"{GROWTH * mean * LONGER:.0f}", f"{back:.2f}",
            f"{numpy.log(0.95 * mean / LEFT) / GROWTH:.2f}", f"{last:.0f}",
            f"{record.process_seconds / 60:.1f}"]


def draw(pairs, path):
    """Height of the proliferating zone over time, and the steady one that the
    fields alone would have, of (case, record of its run)."""
    canvas, axes = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
    for i, (case, record) in enumerate(pairs):
        times, height = heights(record.output)
        axes.plot(times, height, color=COLOURS[i],
                  label=f"PTHrP answers {case.factor:g} times")
        axes.axhline(steady_height(case.answer), linestyle=":",
                     color=COLOURS[i])
    axes.axvline(CUT, color="#444444", linewidth=0.6)
    axes.set(xlabel="day", ylabel="height of proliferation, µm", ylim=(0, None))
    axes.legend(loc="lower left")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path)
    plt.close(canvas)
