# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""An organoid with four crypts under different tensions of its surfaces: how deep
the crypts are, at two volumes of the lumen."""
from dataclasses import dataclass

import numpy
from morula.run import Run
from morula.style import COLOURS, RC, plt

from .spheroids import ROOT

SCENE = ROOT / "prm/showcase/organoid.prm"
BETWEEN = 90.0  # um, initial radius between the inner and the outer surface
CRYPTS = 4
FULL, EMPTY, AGAIN = 1.0, 2.0, 3.0  # days: full of volume, emptied, refilled

HEADER = ["tension, kPa µm", "depth, full, µm", "emptied", "refilled",
          "emptied over full", "pressure, full, Pa", "emptied",
          "volume off, relative", "minutes"]

plt.rcParams.update(RC)


@dataclass(frozen=True)
class Case:
    """The scene with a tension, kPa um."""

    tension: float

    @property
    def name(self):
        return f"organoid, {self.tension:g} kPa um"

    def overrides(self):
        """What is special in the scene, as (key, value)."""
        return (("Boundary conditions/Surface tension",
                 f"{self.tension:g}*min(1, t)"),)


def all_cases():
    return [Case(3.0), Case(6.0), Case(12.0)]


def outline(run, day, inner=True):
    """Boundary points of one surface at the output nearest to a day: x, y, and
    areas, by the angle around the centre of the run's tissue."""
    surface = run.surface(int(numpy.argmin(abs(run.times - day))))
    is_inner = numpy.hypot(surface["X"], surface["Y"]) < BETWEEN
    there = surface[is_inner if inner else ~is_inner]
    return there.iloc[numpy.argsort(numpy.arctan2(there["y"], there["x"]))]


def depth(run, day):
    """Amplitude of the wave of CRYPTS lengths in the radius of the inner
    surface, um; > 0: out where the crypts are."""
    points = outline(run, day)
    angle = numpy.arctan2(points["y"], points["x"])
    radius = numpy.hypot(points["x"], points["y"])
    step = (numpy.roll(angle, -1) - numpy.roll(angle, 1)) % (2 * numpy.pi) / 2
    return (radius * numpy.cos(CRYPTS * angle) * step).sum() / numpy.pi


def wanted_volume(t):
    """Of the lumen, over that at the start."""
    return 1 - 0.4 * (numpy.maximum(0, t - FULL)
                      - 2 * numpy.maximum(0, t - EMPTY))


def volume_error(run):
    rows = run.statistics
    kept = rows["lumen_volume"] / rows["lumen_volume"].iloc[0]
    return abs(kept / wanted_volume(rows["time"]) - 1).max()


def pressure(run, day):
    """In the lumen, Pa."""
    rows = run.statistics
    return 1e3 * numpy.interp(day, rows["time"], rows["lumen_pressure"])


def row(case, record):
    run = Run(record.output)
    depths = [depth(run, day) for day in (FULL, EMPTY, AGAIN)]
    return [f"{case.tension:g}", *(f"{value:.1f}" for value in depths),
            f"{depths[1] / depths[0]:.2f}", f"{pressure(run, FULL):.0f}",
            f"{pressure(run, EMPTY):.0f}", f"{volume_error(run):.0e}",
            f"{record.process_seconds / 60:.1f}"]


def draw(pairs, path):
    """Outlines, full and emptied, and the depth of crypts over the volume of the
    lumen, of (case, record of its run)."""
    canvas, panels = plt.subplots(1, len(pairs) + 1, layout="constrained",
                                  figsize=(2.1 * (len(pairs) + 1) + 1, 2.5))
    for i, (case, record) in enumerate(pairs):
        run, axes = Run(record.output), panels[i]
        for day, shade in ((FULL, "#BBBBBB"), (EMPTY, COLOURS[i])):
            for inner in (True, False):
                points = outline(run, day, inner)
                axes.plot(points["x"], points["y"], ".", markersize=0.8,
                          color=shade)
        axes.set(aspect="equal", title=f"{case.tension:g} kPa µm")
        axes.axis("off")
        days = run.times[run.times >= FULL - 1e-9]
        panels[-1].plot(wanted_volume(days), [depth(run, t) for t in days],
                        ".-", color=COLOURS[i], label=f"{case.tension:g}")
    panels[-1].set(xlabel="lumen, of its first volume",
                   ylabel="depth of crypts, µm")
    panels[-1].legend(title="kPa µm")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path)
    plt.close(canvas)
