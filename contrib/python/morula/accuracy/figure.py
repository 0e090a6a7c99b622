# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The figure: for each measure the error against processor time."""
from morula.columns import pretty
from morula.style import RC, colour, log_ticks, marker, padded, plt


def draw(findings, file):
    """Writes the picture."""
    rows = len(findings.estimates)
    with plt.rc_context(RC):
        figure, panels = plt.subplots(rows, 1, squeeze=False, layout="constrained",
                                      figsize=(6.6, 1.6 + 2.8 * rows))
        for found, axes in zip(findings.estimates, panels.flat):
            cost_panel(axes, findings, found)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
        figure.suptitle(f"{findings.request.scene.name} at day {findings.request.end:g}")
        figure.savefig(file)
        plt.close(figure)


def cost_panel(axes, findings, found):
    """Errors against processor time: each ladder, the Pareto front."""
    plan, seconds = findings.plan, findings.seconds(found)
    shown = [abs(error) for error in found.errors.values()]
    largest = max(*shown, found.floor) or 1.0
    low = 0.4 * max(min(filter(None, shown), default=largest), 1e-5 * largest)
    limits = low, 2.2 * largest
    heights = {point: max(abs(error), 1.25 * low) for point, error in found.errors.items()}
    axes.set(xscale="log", yscale="log", ylim=limits, xlim=padded(seconds.values()),
             xlabel="processor time [s]", ylabel=f"error of {found.measure.text} "
             f"[{pretty(found.measure.unit) or '1'}]")
    log_ticks(axes.xaxis, *axes.get_xlim())
    log_ticks(axes.yaxis, *limits)
    axes.axhspan(low, max(low, found.floor), color="0.92", zorder=0,
                 label="not distinguishable from zero")
    front = findings.front(found)
    x, y = [seconds[point] for point in front], [heights[point] for point in front]
    axes.plot([x[0], *x, 1e3 * max(seconds.values())], [limits[1], *y, y[-1]], color="0.75",
              drawstyle="steps-post", linewidth=5, zorder=1, label="least time for an error (Pareto front)")
    axes.plot(seconds.values(), heights.values(), "o", color="0.6", markersize=3)
    for number, ladder in enumerate(plan.ladders):
        points = [p for p in plan.path(ladder, found.center) if p in seconds]
        axes.plot([seconds[p] for p in points], [heights[p] for p in points],
                  label=ladder.name, color=colour(number), marker=marker(number), markersize=4,
                  linewidth=1.2)
        for point in (p for p in points if p != found.center):
            axes.annotate(plan.rung_label(ladder, point), (seconds[point], heights[point]), (4, 3),
                          fontsize=6, textcoords="offset points", color=colour(number))
    if found.center in seconds:
        axes.plot(seconds[found.center], heights[found.center], "o", markersize=11, zorder=5,
                  markerfacecolor="none", color="black", label="the run that all ladders share")
