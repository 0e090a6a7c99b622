# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Courses of spheroids beside the data."""
import numpy
from morula.style import COLOURS, RC, plt

from .spheroids import radii_of_run

plt.rcParams.update(RC)

NAMES = ("outer radius", "necrotic core", "arrested core")


def draw(pairs, path):
    """A panel for each (series, record of its run)."""
    canvas, panels = plt.subplots(1, len(pairs), sharey=True, squeeze=False,
                                  figsize=(3.4 * len(pairs), 3.2),
                                  layout="constrained")
    for axes, (series, record) in zip(panels[0], pairs):
        times, radii = radii_of_run(record.output)
        days = numpy.linspace(series.days[0], series.days[-1], 200)
        exact = series.greenspan(days)
        for i, name in enumerate(NAMES):
            axes.errorbar(series.days, series.radii[i], fmt="o", markersize=4,
                          yerr=series.deviation if i == 0 else None,
                          color=COLOURS[i], linewidth=0.8)
            axes.plot(days, exact[i], ":", color=COLOURS[i])
            axes.plot(times + series.days[0], radii[i], color=COLOURS[i],
                      label=name)
        axes.set(title=series.name, xlabel="day after seeding")
    panels[0, 0].set_ylabel("radius, µm")
    panels[0, 0].legend(loc="upper left")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path)
    plt.close(canvas)
