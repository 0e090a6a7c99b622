# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fig. 2: the half-fixed sphere grown to a stretch of 1.4 on five grids."""
import functools

from . import layout
from .catalogue import GRIDS
from .outline import profile
from .outline_reference import finite_element_outline
from .pictures import Camera, common_view

COLOURS = dict(zip(GRIDS, ("tab:green", "tab:blue", "tab:orange", "tab:red",
                           "black")))
EXTENT = (375.0, 400.0)  # µm to each side and up and down, (a-e)
BOX = (240.0, 325.0, -15.0, 70.0)  # r, z of Fig. 2 (g), µm


def name_of(run):
    """Spacings (µm) as the legend gives them."""
    return (f"$h$ = {run.number('Grid/Spacing'):g} µm, $L_p$ = "
            f"{run.number('Tissue/Cell spacing'):g} µm")


def draw_shape(scene, runs, path):
    run = runs[scene]
    time = run.last_output
    camera = Camera(common_view([(run, time)], EXTENT), 300)
    layout.picture_grid(
        path, scene[-1], [layout.Row("", [camera.surface(run, time)])],
        [name_of(run).replace(", ", "\n")], camera.micrometres_per_pixel, 200)


def plot_outlines(axes, runs, line_width=1.2):
    for scene in GRIDS:
        run = runs[scene]
        r, z = profile(run, run.last_output)
        axes.plot(r, z, color=COLOURS[scene], label=name_of(run),
                  linewidth=line_width, zorder=3 if scene == "fig-2e" else 2)
    theta = runs["fig-2e"].stretch(runs["fig-2e"].last_output)
    reference = finite_element_outline(theta)
    if reference is not None:
        axes.plot(*reference, color="magenta", linestyle=(0, (2, 1.5)),
                  linewidth=line_width, zorder=4,
                  label="body-fitted finite elements")
    axes.set(xlabel="$r$ [µm]", ylabel="$z$ [µm]", aspect="equal")


def draw_2f(runs, path):
    def draw(axes):
        plot_outlines(axes, runs)
        low, high, bottom, top = BOX
        axes.plot([low, high, high, low, low],
                  [bottom, bottom, top, top, bottom], color="0.4",
                  linewidth=0.8)
        axes.text(high + 6, top, "g", va="top")
        axes.set(xlim=(0, 400), ylim=(-270, 490))
        axes.legend(loc="upper left", bbox_to_anchor=(1.04, 1.0))

    layout.curves(path, "f", draw, plot=(1.8, 3.42), right=2.1)


def draw_2g(runs, path):
    def draw(axes):
        plot_outlines(axes, runs, line_width=1.8)
        axes.set(xlim=BOX[:2], ylim=BOX[2:])
        for side in axes.spines.values():
            side.set_visible(True)

    layout.curves(path, "g", draw, plot=(3.42, 3.42))


PANELS = {**{scene: functools.partial(draw_shape, scene) for scene in GRIDS},
          "fig-2f": draw_2f, "fig-2g": draw_2g}
