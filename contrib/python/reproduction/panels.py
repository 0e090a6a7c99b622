# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The panels of the paper's figures: each a function of the runs that makes a figure
of matplotlib, or the pictures of a video."""
import functools

import matplotlib.pyplot as plt
import numpy as np
from morula import fits

from . import layout, outline
from .catalogue import CHECKPOINTS, GRIDS
from .findings import five_days
from .numbers import CELLS_FIT, ENERGY_FIT, VOLUME_FIT
from .pictures import Camera

GENERATION = "generation", (0, 4)
ENERGY = "energy_density", (0.0, 1.2)  # kPa
SPHERE_2 = (375.0, 400.0)  # µm to each side and up and down of Fig. 2 (a-e) ...
SPHERE_4 = (440.0, 440.0)  # ... and of Fig. 4 (b-d)
COLOURS_2 = dict(zip(GRIDS, ("tab:green", "tab:blue", "tab:orange", "tab:red", "black")))
BOX_2G = (240.0, 325.0, -15.0, 70.0)  # r, z of Fig. 2 (g), µm


def time_and_cells(run, state):
    return f"$t$ = {run.times[state]:.3g} d\n{run.count(state):,} cells"


def over_time(run, states, fields, width):
    """The camera and the rows of pictures of some states; fields are {label: (field, its
    limits, whether cut open)}."""
    camera = Camera.of(run, states[-1], width)
    return camera, {label: [camera.cells(run, state, *field) for state in states]
                    for label, field in fields.items()}


def draw_1d(runs):
    """A cube whose cells all divide: before, just divided, after."""
    run = runs["fig-1d"]
    states = [run.nearest(time) for time in (0.0, 0.5, 1.0)]
    camera, rows = over_time(run, states, {"": ("volume", (700.0, 1300.0))}, 260)
    figure = plt.figure(figsize=(10, 3.3))
    left, right = figure.subfigures(1, 2, width_ratios=(2, 1))
    layout.fill(left, rows, [time_and_cells(run, state) for state in states], camera, 100)
    volume_and_number(right.subplots(), run.statistics)
    layout.letter(figure, "d")
    return figure


def volume_and_number(axes, rows):
    """Mean cell volume, left, and number of cells, right, over time."""
    volume = rows["total_volume"] / rows["cells"]
    left, = axes.plot(rows["time"], volume, color="tab:blue", label="mean cell volume $V_p$")
    axes.set(xlabel="Time [day]", ylabel="Mean cell volume [µm³]", ylim=(0, 2 * volume[0]))
    other = axes.twinx()
    other.spines["right"].set_visible(True)
    right, = other.step(rows["time"], rows["cells"] / 1000, where="post", color="tab:red",
                        label="number of cells $N_p$")
    other.set(ylabel="Number of cells [10³]", ylim=(0, 1.15e-3 * rows["cells"].max()))
    axes.legend(handles=[left, right], loc="lower right")


def spacings(run):
    """As the legend of Fig. 2 gives them."""
    return (f"$h$ = {run.number('Grid/Spacing'):g} µm, "
            f"$L_p$ = {run.number('Tissue/Cell spacing'):g} µm")


def draw_shape(scene, runs):
    """Fig. 2 (a-e): the half-fixed sphere grown to a stretch of 1.4."""
    run = runs[scene]
    camera = Camera.of(run, -1, 300, SPHERE_2)
    return layout.picture_grid(scene[-1], {"": [camera.surface(run, -1)]},
                               [spacings(run).replace(", ", "\n")], camera, 200)


def plot_outlines(axes, runs, line_width=1.2):
    for scene in GRIDS:
        axes.plot(*outline.profile(runs[scene], -1).T, color=COLOURS_2[scene],
                  label=spacings(runs[scene]), linewidth=line_width,
                  zorder=3 if scene == "fig-2e" else 2)
    reference = outline.finite_element_outline(runs["fig-2e"].stretch(-1))
    if reference is not None:
        axes.plot(*reference.T, color="magenta", linestyle=(0, (2, 1.5)), linewidth=line_width,
                  zorder=4, label="body-fitted finite elements")
    axes.set(xlabel="$r$ [µm]", ylabel="$z$ [µm]", aspect="equal")


def draw_2f(runs):
    def draw(axes):
        plot_outlines(axes, runs)
        low, high, bottom, top = BOX_2G
        axes.add_patch(plt.Rectangle((low, bottom), high - low, top - bottom, fill=False,
                                     edgecolor="0.4", linewidth=0.8))
        axes.text(high + 6, top, "g", va="top")
        axes.set(xlim=(0, 400), ylim=(-270, 490))
        axes.legend(loc="upper left", bbox_to_anchor=(1.04, 1.0))

    return layout.curves("f", draw, (4.6, 4.2))


def draw_2g(runs):
    def draw(axes):
        plot_outlines(axes, runs, line_width=1.8)
        axes.set(xlim=BOX_2G[:2], ylim=BOX_2G[2:])
        axes.spines[:].set_visible(True)

    return layout.curves("g", draw, (4.3, 4.2))


def draw_3a(runs):
    """The cube at every stretch that was written."""
    run = runs["fig-3a"]
    states = range(len(run.times))
    camera, rows = over_time(run, states, {"": ("volume", (900.0, 3500.0))}, 200)
    titles = [f"$\\theta$ = {run.stretch(state):.3g}" for state in states]
    return layout.picture_grid("a", rows, titles, camera, 100)


def draw_states(scene, name, fields, width, bar_length, runs):
    """Fields at five times until what the paper shows last."""
    run = runs[scene]
    last = run.times[-1 if scene == "fig-3b" else run.picture_state]
    states = [run.nearest(last * k / 4) for k in range(5)]
    camera, rows = over_time(run, states, fields, width)
    titles = [time_and_cells(run, state) for state in states]
    return layout.picture_grid(name, rows, titles, camera, bar_length)


def scientific(fit):
    """The formula of a fit, as matplotlib writes it."""
    if isinstance(fit, fits.Line):
        sign = "−" if fit.constant < 0 else "+"
        return f"{fit.slope:.3g}$\\,t$ {sign} {abs(fit.constant):.3f}"
    factor = f"{fit.factor * 1e-6:.3g}·10⁶" if fit.factor > 1e6 else f"{fit.factor:.0f}"
    return f"{factor}$\\,e^{{{fit.rate:.3g}t}}$"


def draw_fit(name, column, label, scale, fit, paper, runs):
    """Fig. 3 (c-e): a quantity over time with the paper's fitted function and ours."""
    rows = runs["fig-3b"].statistics
    time, values = rows["time"], rows[column]

    def draw(axes):
        axes.plot(time, values * scale, color="black", label="Morula")
        try:
            ours = fit(time, values)
            axes.plot(time, ours(time) * scale, color="tab:blue", linestyle="--",
                      linewidth=1.1, label=f"fit: {scientific(ours)}")
        except fits.NothingToFit:
            pass  # a trial that ends early
        axes.plot(time, paper(time) * scale, color="tab:orange", linestyle=":",
                  label=f"paper: {scientific(paper)}")
        axes.axvspan(*fits.RANGE, color="0.93", zorder=0, linewidth=0)
        axes.set(xlabel="Time [day]", ylabel=label, xlim=(0, time.max()),
                 ylim=(min(0, values.min() * scale), None))
        axes.legend(loc="upper left", borderaxespad=0.1, handlelength=1.6)

    return layout.curves(name, draw)


def checkpoint(run):
    return f"$J_{{th}}$ = {run.threshold:g}" if run.threshold else "no checkpoint"


def draw_column(scene, runs):
    """Fig. 4 (b-d): generation and energy density, cut open, and the outer shape."""
    run = runs[scene]
    if scene == "fig-4d":
        state, title = -1, f"hypertrophy\n$\\theta$ = {run.stretch(-1):.3g}"
    else:
        state = run.picture_state
        title = f"{checkpoint(run)}\n" + time_and_cells(run, state).replace("\n", ", ")
    camera = Camera.of(run, state, 300, SPHERE_4)
    rows = {"Generation": [camera.cells(run, state, *GENERATION, True)],
            "Energy density $\\Psi_p$": [camera.cells(run, state, *ENERGY, True)],
            "Outer shape": [camera.surface(run, state)]}
    return layout.picture_grid(scene[-1], rows, [title], camera, 200)


def draw_series(name, x, y, xlabel, ylabel, scales, runs):
    """Fig. 4 (e-g): curves for five checkpoints."""
    def draw(axes):
        shades = plt.get_cmap("viridis")(np.linspace(0, 0.9, len(CHECKPOINTS)))
        for scene, colour in zip(CHECKPOINTS, shades):
            rows = five_days(runs[scene])
            axes.plot(rows[x] * scales[0], rows[y] * scales[1], color=colour,
                      label=checkpoint(runs[scene]))
        axes.set(xlabel=xlabel, ylabel=ylabel, ylim=(0, None))
        axes.set_xlim(0 if x == "time" else None, None)
        axes.legend(loc="upper left", borderaxespad=0.1, handlelength=1.4)

    return layout.curves(name, draw)


def video(scene, cut, runs):
    """Generation and energy density, a picture for each output until the last state
    that the paper shows."""
    run = runs[scene]
    last = len(run.times) - 1 if scene == "fig-3b" else run.picture_state
    camera = Camera.of(run, last, 320)
    for state in range(last + 1):
        row = [camera.cells(run, state, *field, cut) for field in (GENERATION, ENERGY)]
        yield layout.picture_grid("", {"": row}, [time_and_cells(run, state), ""], camera, 200)


NUMBER, VOLUME, MEAN_ENERGY = ("Number of cells $N_p$", "Total volume $V_{tot}$ [10⁶ µm³]",
                               "Mean energy density $\\Psi_{ave}$ [kPa]")
CUBE_FIELDS = {"Generation": GENERATION, "Cell volume $V_p$": ("volume", (300.0, 2200.0)),
               "Energy density $\\Psi_p$": ENERGY}
SPHERE_FIELDS = {label: ("volume", (200.0, 2400.0), cut)
                 for label, cut in (("Outside", False), ("Cut open", True))}
of = functools.partial
DRAW = {
    "fig-1d": draw_1d,
    **{scene: of(draw_shape, scene) for scene in GRIDS},
    "fig-2f": draw_2f,
    "fig-2g": draw_2g,
    "fig-3a": draw_3a,
    "fig-3b": of(draw_states, "fig-3b", "b", CUBE_FIELDS, 240, 100),
    "fig-3c": of(draw_fit, "c", "cells", NUMBER + " [10³]", 1e-3, fits.fit_exponential,
                 CELLS_FIT),
    "fig-3d": of(draw_fit, "d", "total_volume", VOLUME, 1e-6, fits.fit_exponential, VOLUME_FIT),
    "fig-3e": of(draw_fit, "e", "mean_energy_density", MEAN_ENERGY, 1.0, fits.fit_line,
                 ENERGY_FIT),
    "fig-4a": of(draw_states, "fig-4c", "a", SPHERE_FIELDS, 240, 200),
    **{scene: of(draw_column, scene) for scene in ("fig-4b", "fig-4c", "fig-4d")},
    "fig-4e": of(draw_series, "e", "time", "cells", "Time [day]", NUMBER + " [10⁵]",
                 (1, 1e-5)),
    "fig-4f": of(draw_series, "f", "cells", "total_volume", NUMBER + " [10⁵]", VOLUME,
                 (1e-5, 1e-6)),
    "fig-4g": of(draw_series, "g", "cells", "mean_energy_density", NUMBER + " [10⁵]",
                 MEAN_ENERGY, (1e-5, 1)),
    "video-1": of(video, "fig-3b", False),
    "video-2": of(video, "fig-4b", True),
    "video-3": of(video, "fig-4c", True),
}
