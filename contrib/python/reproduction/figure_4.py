# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fig. 4: the half-fixed sphere proliferating, with and without checkpoint."""
import functools

import matplotlib.pyplot as plt
import numpy as np

from . import layout, stated
from .catalogue import CHECKPOINTS
from .pictures import Camera, common_view

VOLUMES = (200.0, 2400.0)  # µm³
GENERATIONS = (0, 4)
ENERGIES = (0.0, 1.2)  # kPa
EXTENT = (440.0, 440.0)  # µm to each side and up and down, (b-d)
WIDTH = 300  # pixels of a picture


def threshold(run):
    """J_th of the size checkpoint; 0: none."""
    return run.number("Proliferation/Cell cycle/Size checkpoint")


def five_days(run):
    """The statistics up to the end of the curves. The run of Fig. 4 (b) was
    continued beyond it; all others of the series end there."""
    return run.until(stated.CURVES_END)


def picture_time(run):
    """When the paper shows a run: at 1.5³ times the founders."""
    return run.output_with_cells(stated.PICTURE_RATIO * run.founders)


def draw_4a(runs, path):
    """Cell volumes without checkpoint over time, from outside and cut open."""
    run = runs["fig-4c"]
    end = picture_time(run)
    times = [run.output_nearest(end * k / 4) for k in range(5)]
    camera = Camera(common_view([(run, end)]), 240)
    rows = []
    for label, cut in (("Outside", False), ("Cut open", True)):
        images, colours = zip(*(camera.cells(run, time, "volume", VOLUMES, cut)
                                for time in times))
        rows.append(layout.Row(label, images, colours[0]))
    layout.picture_grid(
        path, "a", rows,
        [f"$t$ = {time:.3g} d\n{run.cells_at(time):,} cells" for time in times],
        camera.micrometres_per_pixel, 200)


def draw_column(scene, runs, path):
    """Generation and energy density, cut open, and the outer shape."""
    run = runs[scene]
    if scene == "fig-4d":
        time = run.last_output
        title = f"hypertrophy\n$\\theta$ = {run.stretch(time):.3g}"
    else:
        time = picture_time(run)
        title = (f"{name_of(run)}\n$t$ = {time:.3g} d, "
                 f"{run.cells_at(time):,} cells")
    camera = Camera(common_view([(run, time)], EXTENT), WIDTH)
    generation, generations = camera.cells(run, time, "generation",
                                           GENERATIONS, cut=True)
    energy, energies = camera.cells(run, time, "energy_density", ENERGIES,
                                    cut=True)
    layout.picture_grid(
        path, scene[-1],
        [layout.Row("Generation", [generation], generations),
         layout.Row("Energy density $\\Psi_p$", [energy], energies),
         layout.Row("Outer shape", [camera.surface(run, time)])],
        [title], camera.micrometres_per_pixel, 200)


def name_of(run):
    """A run's name in titles and legends."""
    return (f"$J_{{th}}$ = {threshold(run):g}" if threshold(run) else
            "no checkpoint")


def draw_curves(which, runs, path):
    """Cells over time (e), volume (f) and energy (g) over cells."""
    x, y, labels, scales = {
        "e": ("time", "cells", ("Time [day]", "Number of cells $N_p$ [10⁵]"),
              (1, 1e-5)),
        "f": ("cells", "total_volume", ("Number of cells $N_p$ [10⁵]",
              "Total volume $V_{tot}$ [10⁶ µm³]"), (1e-5, 1e-6)),
        "g": ("cells", "mean_energy_density", ("Number of cells $N_p$ [10⁵]",
              "Mean energy density $\\Psi_{ave}$ [kPa]"), (1e-5, 1)),
    }[which]

    def draw(axes):
        shades = plt.get_cmap("viridis")(np.linspace(0, 0.9, len(CHECKPOINTS)))
        for scene, colour in zip(CHECKPOINTS, shades):
            rows = five_days(runs[scene])
            axes.plot(rows[x] * scales[0], rows[y] * scales[1], color=colour,
                      label=name_of(runs[scene]))
        axes.set(xlabel=labels[0], ylabel=labels[1], ylim=(0, None))
        axes.set_xlim(0 if which == "e" else None, None)
        axes.legend(loc="upper left", borderaxespad=0.1, handlelength=1.4)

    layout.curves(path, which, draw)


PANELS = {
    "fig-4a": draw_4a,
    **{scene: functools.partial(draw_column, scene)
       for scene in ("fig-4b", "fig-4c", "fig-4d")},
    **{f"fig-4{which}": functools.partial(draw_curves, which)
       for which in "efg"}}
