# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Error against wall time, unknowns and memory."""
from morula.style import Labels, colour, log_ticks, marker, padded, plt

from .findings import KINDS
from .report import pretty


def cost_figure(findings, estimate):
    """The three side by side."""
    figure, panels = plt.subplots(1, 3, figsize=(12.5, 5.2), sharey=True)
    limits = error_limits(findings, estimate)
    figure.subplots_adjust(0.07, 0.24, 0.93, 0.93, wspace=0.07)
    for axes, kind in zip(panels, KINDS):
        cost_panel(axes, findings, estimate, kind, limits)
    unit = pretty(estimate.measure.unit)
    panels[0].set_ylabel("error" + (f" [{unit}]" if unit else ""))
    if abs(estimate.right) > 0:
        per_cent_axis(panels[-1], estimate.right, limits)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=4)
    right = estimate.source if estimate.compared_with else "right value"
    figure.suptitle(f"{findings.request.scene.name}: {estimate.measure.text} "
                    f"at day {estimate.time:g}, {right} "
                    f"{estimate.right:.6g} {unit}".rstrip(), fontsize=11)
    return figure


def error_limits(findings, estimate):
    """From below the smallest error that means something, or is wanted, to
    above the largest."""
    shown = [abs(error) for error in estimate.errors.values() if error != 0]
    wanted = findings.wanted(estimate)
    marks = [wanted] if wanted else []
    largest = max(shown + marks, default=1.0)
    smallest = max(min(shown, default=largest), 0.1 * estimate.floor,
                   1e-5 * largest)
    return 0.4 * min([smallest, *marks]), 2.2 * max(largest, estimate.floor)


def cost_panel(axes, findings, estimate, kind, limits):
    plan, center = findings.plan, estimate.center
    costs = dict(zip(estimate.values, findings.cost(estimate, kind)))
    heights = {point: max(abs(error), limits[0] * 1.25)
               for point, error in estimate.errors.items()}
    axes.set(xscale="log", yscale="log", ylim=limits, xlabel=KINDS[kind],
             xlim=padded(costs.values()))
    log_ticks(axes.xaxis, *axes.get_xlim())
    log_ticks(axes.yaxis, *limits)
    axes.grid(True, which="major", color="0.9", linewidth=0.6, zorder=-1)
    if estimate.floor > limits[0]:
        axes.axhspan(limits[0], estimate.floor, color="0.92", zorder=0,
                     label="cannot be told from zero")
    draw_front(axes, findings, estimate, kind, costs, limits)
    if plan.full_grid:
        axes.plot(list(costs.values()), list(heights.values()), "o",
                  color="0.6", markersize=3, zorder=2)
    labels = Labels(axes)
    for point in costs:
        labels.block(costs[point], heights[point])
    for number, ladder in enumerate(plan.ladders):
        draw_ladder(axes, plan, center, number, ladder, costs, heights, labels)
    if center in costs:
        axes.plot(costs[center], heights[center], "o", markersize=11,
                  markerfacecolor="none", color="black", markeredgewidth=1.2,
                  label="finest corner" if plan.full_grid
                  else "the scene itself", zorder=5, linestyle="none")
    draw_wanted(axes, findings, estimate, kind, costs, heights)


def draw_ladder(axes, plan, center, number, ladder, costs, heights, labels):
    """The line of a ladder in the order of its values, its rungs named."""
    points = [p for p in plan.path(ladder, center) if p in costs]
    axes.plot([costs[p] for p in points], [heights[p] for p in points],
              color=colour(number), marker=marker(number), markersize=5,
              linewidth=1.2, label=ladder.name, zorder=3)
    for point in points:
        if point != center:
            labels.add(costs[point], heights[point],
                       plan.rung_label(ladder, point), colour(number))


def draw_front(axes, findings, estimate, kind, costs, limits):
    """The Pareto front as a staircase: what an error costs at least."""
    front = findings.front(estimate, kind)
    x = [costs[point] for point in front]
    y = [estimate.effective(point) for point in front]
    axes.plot([x[0], *x, 1e3 * max(costs.values())],
              [limits[1], *y, y[-1]], drawstyle="steps-post", color="0.75",
              linewidth=5, solid_capstyle="butt", zorder=1,
              label="least cost for an error (Pareto front)")


def draw_wanted(axes, findings, estimate, kind, costs, heights):
    wanted = findings.wanted(estimate)
    if wanted is None:
        return
    text = findings.request.wanted[estimate.measure].text
    axes.axhline(wanted, color="black", linestyle=(0, (5, 3)), linewidth=0.9,
                 label=f"wanted: {text}", zorder=2)
    best = findings.least_cost(estimate, kind)
    if best is not None:
        axes.plot(costs[best], heights[best], "*", color="#F0C000",
                  markeredgecolor="black", markersize=15, zorder=7,
                  label="cheapest that is surely as good", linestyle="none")


def per_cent_axis(axes, right, limits):
    """The same errors on the right-hand side, relative to the right value."""
    scale = 100 / abs(right)
    twin = axes.secondary_yaxis("right", functions=(lambda y: y * scale,
                                                    lambda y: y / scale))
    twin.set_ylabel("of the right value [%]")
    log_ticks(twin.yaxis, *(scale * limit for limit in limits))
