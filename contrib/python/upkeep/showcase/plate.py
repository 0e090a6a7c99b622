# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A growth plate that two morphogens regulate: the scene with different answers
of PTHrP to Ihh, and where the fields alone put the end of proliferation."""
import numpy
from morula.style import COLOURS, plt
from scipy.integrate import simpson
from scipy.optimize import brentq

from . import SCENES, Case

SCENE = SCENES / "growth-plate.prm"

REACH_IHH, REACH_PTHRP = 150.0, 100.0  # um, roots of D over the loss
ANSWER = 279.4  # of PTHrP to Ihh, 1/day
WALL = 50.0  # um from the wall, where cells answer
GROWTH = numpy.log(2) / 1.2875  # 1/day, of proliferating tissue
LONGER = 2.44  # by which factor hypertrophy makes a cell longer
CUT, LEFT = 3.0, 150.0  # day, and height to which the zone is cut, um
PROLIFERATING, HYPERTROPHIC = 0, 1

HEADER = ["answer of PTHrP", "height, µm", "from the fields alone, µm", "growth, µm/day",
          "ln 2/T · height · 2.44", "days to come back", "from the height",
          "height at the end, µm", "minutes"]


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


def cases():
    return [Case(f"growth plate, answer times {factor:g}", {} if factor == 1 else {
                 "Fields/pthrp/Production": f"{factor * ANSWER:g}*ihh*(y < {WALL:g})"},
                 (factor,)) for factor in (1, 0.5, 2)]


def heights(run):
    """Times, and heights of the proliferating zone where it fills the whole width, um."""
    found = []
    for i in range(len(run.times)):
        cells = run.cells(i)
        found.append((cells["y"][cells["type"] == PROLIFERATING].max()
                      + cells["y"][cells["type"] == HYPERTROPHIC].min()) / 2)
    return run.times, numpy.array(found)


def row(case, run):
    times, height = heights(run)
    mean = height[(times > 1.5) & (times < CUT - 1e-9)].mean()
    rows = run.statistics
    rows = rows[(rows["time"] > 1.5) & (rows["time"] < CUT - 1e-9)]
    speed = numpy.polyfit(rows["time"], rows["ymax"], 1)[0]
    back = times[(times > CUT + 0.01) & (height >= 0.95 * mean)]
    return [f"{case.values[0]:g}", f"{mean:.0f}", f"{steady_height(case.values[0] * ANSWER):.0f}",
            f"{speed:.0f}", f"{GROWTH * mean * LONGER:.0f}",
            f"{back[0] - CUT if len(back) else numpy.nan:.2f}",
            f"{numpy.log(0.95 * mean / LEFT) / GROWTH:.2f}",
            f"{height[times > times[-1] - 0.55].mean():.0f}"]


def draw(pairs):
    canvas, axes = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
    for i, (case, run) in enumerate(pairs):
        axes.plot(*heights(run), color=COLOURS[i], label=f"PTHrP answers {case.values[0]:g} times")
        axes.axhline(steady_height(case.values[0] * ANSWER), linestyle=":", color=COLOURS[i])
    axes.axvline(CUT, color="#444444", linewidth=0.6)
    axes.set(xlabel="day", ylabel="height of proliferation, µm", ylim=(0, None))
    axes.legend(loc="lower left")
    return canvas
