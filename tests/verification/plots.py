# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Errors against h, L_p and dt on logarithmic axes, several cases a figure; and
a picture of the vortex."""
import matplotlib
import numpy

from tests.cases.case import Trial
from tests.common.results import initial_positions, positions

matplotlib.use("Agg")
from matplotlib import pyplot, ticker

# One colour a case in all figures: Okabe & Ito's without yellow, two more.
COLOURS = {"vortex": "#0072B2", "self_weight": "#E69F00",
           "cantilever": "#009E73", "fitted": "#CC79A7",
           "graded_growth": "#D55E00", "core_shell": "#56B4E9",
           "slip_symmetry": "#000000", "confined_growth": "#7B5AA6",
           "patch": "#8C6D31"}
STYLES = ["-", "--", ":"]  # of several ladders of a case
MARKERS = ["o", "s", "^"]

# File, what is varied, the slopes of the triangles in both panels.
FIGURES = [("errors-h", "h [µm]", (2, 3), (1, 2)),
           ("errors-cells", "L_p [µm]", (1, 2), (1, 2)),
           ("errors-dt", "dt [day]", (), ())]


def triangle(axes, slope, corner, width=0.13):
    """A slope triangle whose right angle is at a corner (axes fractions)."""
    to_data = axes.transAxes + axes.transData.inverted()
    x_0, y_0 = to_data.transform(corner)
    x_1, _ = to_data.transform((corner[0] + width, corner[1]))
    y_1 = y_0 * (x_1 / x_0)**slope
    axes.fill([x_0, x_1, x_1], [y_0, y_0, y_1], facecolor="#dddddd",
              edgecolor="#888888", linewidth=0.8, zorder=0)
    axes.annotate(f"{slope}", (x_1, (y_0 * y_1)**0.5), xytext=(3, 0),
                  textcoords="offset points", va="center", fontsize=8,
                  color="#444444")


def draw_panel(axes, chosen, error, slopes):
    drawn = {}
    for name, measured in chosen:
        style = drawn.setdefault(name, 0)
        drawn[name] += 1
        axes.loglog(measured.sizes, measured.errors[error],
                    color=COLOURS[name], linestyle=STYLES[style % 3],
                    marker=MARKERS[style % 3], markersize=3.5, linewidth=1.3,
                    label=measured.ladder.label)
    axes.set_title(f"{error.capitalize()}, relative $L^2$ error", fontsize=9,
                   loc="left")
    axes.grid(which="major", color="#e6e6e6", linewidth=0.6)
    axes.tick_params(labelsize=8)
    for spine in ("top", "right"):
        axes.spines[spine].set_visible(False)
    if chosen and max(m.sizes[0] / m.sizes[-1] for _, m in chosen) < 100:
        axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axes.xaxis.set_minor_formatter(ticker.NullFormatter())
    if slopes:
        low, high = axes.get_ylim()
        axes.set_ylim(low / 5, high)
        for i, slope in enumerate(slopes):
            triangle(axes, slope, (0.52 + 0.24 * i, 0.04))


def draw(measured_by_case, directory):
    """Draws the figures of all ladders that have a label; returns the files."""
    files = []
    for file, varied, *slopes in FIGURES:
        chosen = [(name, measured)
                  for name, ladders in measured_by_case.items()
                  for measured in ladders
                  if measured.ladder.label and measured.ladder.varied == varied
                  and len(measured.sizes) > 1]
        if not chosen:
            continue
        figure, panels = pyplot.subplots(1, 2, figsize=(9.5, 4.0))
        for axes, error, slope in zip(panels, ("displacement", "stress"),
                                      slopes):
            draw_panel(axes, chosen, error, slope)
            axes.set_xlabel(varied.replace("L_p", "$L_p$")
                            .replace("h ", "$h$ ").replace("dt", r"$\Delta t$"),
                            fontsize=9)
        handles, labels = panels[0].get_legend_handles_labels()
        figure.tight_layout(rect=(0, 0, 0.77, 1))
        figure.legend(handles, labels, loc="center left", fontsize=8,
                      bbox_to_anchor=(0.775, 0.5), frameon=False,
                      handlelength=2.6)
        files.append(directory / f"{file}.png")
        figure.savefig(files[-1], dpi=100)
        pyplot.close(figure)
    return files


PICTURE = {"Grid/Spacing": "15", "Tissue/Cell spacing": "1.875",
           "Time/Step": "0.05"}


def draw_vortex(execution, file):
    """Runs the vortex in ten steps and draws its cells on their grid before and
    after, in sectors that show how they move."""
    run, _ = execution.run("verification/picture", Trial(
        "vortex", "vortex-2d.prm", keys=PICTURE))
    cells = run.results.last_cells()
    X = initial_positions(cells)
    sector = numpy.floor(6 * numpy.arctan2(X[:, 1], X[:, 0]) / numpy.pi) % 2
    inside = abs(numpy.hypot(X[:, 0], X[:, 1]) - 100) < 25
    colours = numpy.array([["#dedede", "#ededed"], ["#0072B2", "#9ccbe6"]])[
        inside.astype(int), sector.astype(int)]
    figure, panels = pyplot.subplots(1, 2, figsize=(8.6, 4.6))
    lines = numpy.arange(-150, 151, float(PICTURE["Grid/Spacing"]))
    for axes, x, title in zip(panels, (X, positions(cells)),
                              ("Before", "Turned by up to 0.5 rad")):
        axes.scatter(x[:, 0], x[:, 1], s=4.5, marker="s", linewidths=0,
                     c=colours)
        axes.hlines(lines, -150, 150, color="black", linewidth=0.2)
        axes.vlines(lines, -150, 150, color="black", linewidth=0.2)
        axes.set_aspect("equal")
        axes.set_axis_off()
        axes.set_title(title, fontsize=9, loc="left")
    figure.tight_layout(pad=0.6)
    figure.savefig(file, dpi=90)
    pyplot.close(figure)
    return file
