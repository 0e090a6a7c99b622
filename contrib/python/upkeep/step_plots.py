# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Plots of the tables that the step programs print."""
import numpy as np
from morula.style import COLOURS, RC, log_ticks, plt

plt.rcParams.update(RC)

CUT, INNER = "#F6D7BD", "#CFE3F1"  # classes of grid cells


def figure(n_panels, width=3.4, height=2.9):
    return plt.subplots(1, n_panels, figsize=(width * n_panels, height),
                        layout="constrained")


def fills(radius, h, offset, n=40):
    """How full grid cells are of a disc, by their coordinates (3.1)."""
    fill = {}
    reach = int(radius / h) + 2
    inside = (np.arange(n) + 0.5) / n
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            x = offset[0] + (i + inside) * h
            y = offset[1] + (j + inside) * h
            part = np.mean(x[:, None]**2 + y[None, :]**2 < radius**2)
            if part > 0:
                fill[i, j] = part
    return fill


def draw_grid(axes, radius, h, offset, occupation=0.85):
    """The disc on the grid, cut grid cells and inner ones in their colours."""
    for (i, j), part in fills(radius, h, offset).items():
        axes.add_patch(plt.Rectangle(
            (offset[0] + i * h, offset[1] + j * h), h, h, linewidth=0.5,
            edgecolor="0.6", facecolor=INNER if part >= occupation else CUT))
    axes.add_patch(plt.Circle((0, 0), radius, fill=False, linewidth=1.5))
    axes.set(xlim=(-1.3 * radius, 1.3 * radius), aspect="equal",
             ylim=(-1.3 * radius, 1.3 * radius))
    axes.set_axis_off()


def step_1(tables, path):
    conditions = tables[1]
    canvas, (left, right) = figure(2)
    worst = int(np.argmax(conditions["plain"]))
    shift = conditions["offset"][worst]
    draw_grid(left, 170, 50, (shift, 0.6 * shift))
    left.set_title(f"the disc, grid lines shifted by {shift:.1f} µm")
    for name, colour, line in (("plain", 1, "-"), ("plain, scaled", 1, ":"),
                               ("extended", 0, "-"),
                               ("extended, scaled", 0, ":")):
        right.semilogy(conditions["offset"], conditions[name], line,
                       color=COLOURS[colour], marker="o", markersize=3,
                       label=name)
    right.set(xlabel="offset of the grid, µm", ylabel="condition number")
    right.legend(loc="upper right", bbox_to_anchor=(1, 0.55), fontsize=8)
    canvas.savefig(path)


def step_2(tables, cells, path):
    errors, = tables
    canvas, (left, right) = figure(2)
    points = left.scatter(cells["x"], cells["y"], s=0.4, c=cells["sigma_xy"],
                          cmap="coolwarm", linewidths=0, vmin=-0.18, vmax=0.18)
    left.set(aspect="equal", xlabel="x, µm", ylabel="y, µm")
    canvas.colorbar(points, ax=left, label="$\\sigma_{xy}$, kPa", shrink=0.7)
    for i, (name, unit, order) in enumerate(
            (("displacement", " [µm]", 3), ("gap", " [µm]", 3),
             ("deformation", "", 2))):
        right.loglog(errors["h"], errors[name], "o-", color=COLOURS[i],
                     markersize=4, label=f"{name}{unit}")
        slope = errors[name][-1] * (np.array(errors["h"])
                                    / errors["h"][-1])**order
        right.loglog(errors["h"], slope, "--", color=COLOURS[i], linewidth=0.7)
    right.set(xlabel="grid spacing h, µm", ylabel="error")
    right.set_xticks(errors["h"], [f"{h:g}" for h in errors["h"]])
    right.minorticks_off()
    right.legend(fontsize=8)
    canvas.savefig(path)


def step_4(tables, path):
    rows, = tables
    canvas, panels = figure(2)
    for axes, column, name in ((panels[0], "error, %", "apex"),
                               (panels[1], "error, % 2", "mean energy")):
        for i, clamp in enumerate(("symmetric", "unsymmetric")):
            chosen = [k for k, c in enumerate(rows["clamp"]) if c == clamp]
            seconds = [rows["seconds"][k] for k in chosen]
            error = [abs(rows[column][k]) for k in chosen]
            axes.loglog(seconds, error, "o-", color=COLOURS[i], markersize=4,
                        label=clamp)
            for k, x, y in zip(chosen, seconds, error):
                axes.annotate(f"{rows['h'][k]:g}", (x, y), xytext=(4, 4),
                              textcoords="offset points", fontsize=7,
                              color=COLOURS[i])
        axes.set(xlabel="wall time, s", ylabel=f"error of the {name}, %")
        axes.margins(x=0.15, y=0.15)
        log_ticks(axes.xaxis, *axes.get_xlim())
        log_ticks(axes.yaxis, *axes.get_ylim())
    panels[0].legend(fontsize=8)
    canvas.savefig(path)


def step_6(layers, path):
    canvas, panels = figure(2)
    for axes, column, label in (
            (panels[0], "cells_per_founder", "cells per founder"),
            (panels[1], "J_e", "mean elastic volume ratio $J_e$")):
        for i, threshold in enumerate(sorted(set(layers["J_th"]))):
            chosen = layers["J_th"] == threshold
            axes.plot(layers[column][chosen],
                      100 * layers["layer"][chosen] - 200, "o-",
                      color=COLOURS[i], markersize=4,
                      label=f"$J_{{th}}$ = {threshold:g}")
        axes.axhline(0, color="0.7", linewidth=0.8, zorder=0)
        axes.set(xlabel=label, ylabel="founder's height Z, µm")
    panels[0].annotate("clamp below", (0.6, 0.43), xycoords="axes fraction",
                       fontsize=8, color="0.4")
    panels[1].legend(fontsize=8)
    canvas.savefig(path)


def step_7(runs, path):
    """Mean energy and width over time of runs: name -> statistics."""
    canvas, panels = figure(2)
    for i, (name, rows) in enumerate(runs.items()):
        panels[0].plot(rows["time"], rows["mean_energy_density"],
                       color=COLOURS[i])
        panels[1].plot(rows["time"], rows["ymax"] - rows["ymin"],
                       color=COLOURS[i], label=name)
    panels[0].set(xlabel="time, days", ylabel="mean energy density, kPa")
    panels[1].set(xlabel="time, days", ylabel="largest width, µm")
    panels[1].legend(fontsize=7)
    canvas.savefig(path)
