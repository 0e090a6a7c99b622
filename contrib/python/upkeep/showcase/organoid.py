# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""An organoid with four crypts under different tensions of its surfaces: how deep
the crypts are, at two volumes of the lumen."""
import numpy
from morula.style import COLOURS, plt

from . import SCENES, Case

SCENE = SCENES / "organoid.prm"
BETWEEN = 90.0  # um, initial radius between the inner and the outer surface
CRYPTS = 4
FULL, EMPTY, AGAIN = 1.0, 2.0, 3.0  # days: full of volume, emptied, refilled

HEADER = ["tension, kPa µm", "depth, full, µm", "emptied", "refilled", "emptied over full",
          "pressure, full, Pa", "emptied", "volume off, relative", "minutes"]


def cases():
    return [Case(f"organoid, {tension} kPa um",
                 {"Boundary conditions/Surface tension": f"{tension}*min(1, t)"}, (tension,))
            for tension in (3, 6, 12)]


def outline(run, day, inner=True):
    """Boundary points of one surface at the output nearest to a day, by their angle."""
    surface = run.surface(int(numpy.argmin(abs(run.times - day))))
    is_inner = numpy.hypot(surface["X"], surface["Y"]) < BETWEEN
    there = surface[is_inner == inner]
    return there.iloc[numpy.argsort(numpy.arctan2(there["y"], there["x"]))]


def depth(run, day):
    """Amplitude of the wave of CRYPTS lengths in the radius of the inner surface, um."""
    points = outline(run, day)
    angle = numpy.arctan2(points["y"], points["x"])
    radius = numpy.hypot(points["x"], points["y"])
    step = (numpy.roll(angle, -1) - numpy.roll(angle, 1)) % (2 * numpy.pi) / 2
    return (radius * numpy.cos(CRYPTS * angle) * step).sum() / numpy.pi


def wanted_volume(t):
    """Of the lumen, over that at the start."""
    return 1 - 0.4 * (numpy.maximum(0, t - FULL) - 2 * numpy.maximum(0, t - EMPTY))


def volume_error(run):
    rows = run.statistics
    kept = rows["lumen_volume"] / rows["lumen_volume"].iloc[0]
    return abs(kept / wanted_volume(rows["time"]) - 1).max()


def row(case, run):
    rows = run.statistics
    depths = [depth(run, day) for day in (FULL, EMPTY, AGAIN)]
    pressures = 1e3 * numpy.interp((FULL, EMPTY), rows["time"], rows["lumen_pressure"])
    return [f"{case.values[0]}", *(f"{value:.1f}" for value in depths),
            f"{depths[1] / depths[0]:.2f}", *(f"{value:.0f}" for value in pressures),
            f"{volume_error(run):.0e}"]


def draw(pairs):
    canvas, panels = plt.subplots(1, len(pairs) + 1, layout="constrained",
                                  figsize=(2.1 * (len(pairs) + 1) + 1, 2.5))
    for i, (case, run) in enumerate(pairs):
        for day, shade in ((FULL, "#BBBBBB"), (EMPTY, COLOURS[i])):
            for inner in (True, False):
                points = outline(run, day, inner)
                panels[i].plot(points["x"], points["y"], ".", markersize=0.8, color=shade)
        panels[i].set(aspect="equal", title=f"{case.values[0]} kPa µm")
        panels[i].axis("off")
        days = run.times[run.times >= FULL - 1e-9]
        panels[-1].plot(wanted_volume(days), [depth(run, t) for t in days], ".-",
                        color=COLOURS[i], label=f"{case.values[0]}")
    panels[-1].set(xlabel="lumen, of its first volume", ylabel="depth of crypts, µm")
    panels[-1].legend(title="kPa µm")
    return canvas
