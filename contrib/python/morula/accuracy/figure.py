# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The figure: a row for each measure; error against wall time, the
change along each ladder alone, the results against where the grid lies."""
from morula.columns import pretty
from morula.scene import as_number
from morula.style import RC, colour, log_ticks, marker, padded, plt

from .report import scale_of

DASHED, DOTTED = (0, (5, 3)), (0, (1, 1.5))


def draw(findings, directory):
    """Writes accuracy.png."""
    with plt.rc_context(RC):
        figure = figure_of(findings)
        figure.savefig(directory / "accuracy.png")
        plt.close(figure)


def figure_of(findings):
    request, plan, scatters = findings.request, findings.plan, findings.scatters
    estimates = {e.measure: e for e in findings.estimates}
    ladders = plan.ladders if any(e.parts for e in estimates.values()) else []
    directions = "xyz"[:request.scene.dimension] if scatters else ""
    widths = [4.2] * bool(estimates) + [1.9] * len(ladders) + [2.2] * len(directions)
    rows = [m for m in request.measures if m in estimates or any(s.measure == m for s in scatters)]
    figure, panels = plt.subplots(len(rows), len(widths), squeeze=False, width_ratios=widths,
                                  figsize=(2.4 + sum(widths), 1.6 + 2.6 * len(rows)))
    for measure, axes in zip(rows, panels):
        axes, first = iter(axes), None
        if measure in estimates:
            cost_panel(next(axes), findings, estimates[measure])
        for number, _ in enumerate(ladders):  # what matters is what is steep
            panel = next(axes)
            first = first or panel
            panel.sharey(first)
            ladder_panel(panel, plan, estimates[measure], number)
        for direction, _ in enumerate(directions):
            offsets_panel(next(axes), plan, scatters, measure, direction)
    handles = {label: handle for axes in panels.flat
               for handle, label in zip(*axes.get_legend_handles_labels())}
    figure.legend(handles.values(), handles, loc="lower center", ncols=3)
    figure.suptitle(f"{request.scene.name} at day {request.end:g}; dashed: limit of "
                    "a ladder; dotted: reference file", fontsize=9)
    space = (0.3 + 0.08 * len(handles)) / figure.get_figheight()
    figure.tight_layout(rect=(0, space, 1, 1))
    return figure


def cost_panel(axes, findings, found):
    """Errors against wall time: each ladder, the Pareto front."""
    plan, walls = findings.plan, findings.walls(found)
    shown = [abs(error) for error in found.errors.values()]
    largest = max(*shown, found.floor) or 1.0
    low = 0.4 * max(min(filter(None, shown), default=largest), 1e-5 * largest)
    limits = low, 2.2 * largest
    heights = {point: max(abs(error), 1.25 * low) for point, error in found.errors.items()}
    axes.set(xscale="log", yscale="log", ylim=limits, xlim=padded(walls.values()),
             xlabel="wall time [s]", ylabel=f"error of {found.measure.text} "
             f"[{pretty(found.measure.unit) or '1'}]")
    log_ticks(axes.xaxis, *axes.get_xlim())
    log_ticks(axes.yaxis, *limits)
    axes.axhspan(low, max(low, found.floor), color="0.92", zorder=0,
                 label="cannot be told from zero")
    front = findings.front(found)
    x, y = [walls[point] for point in front], [heights[point] for point in front]
    axes.plot([x[0], *x, 1e3 * max(walls.values())], [limits[1], *y, y[-1]], drawstyle="steps-post",
              color="0.75", linewidth=5, zorder=1, label="least time for an error (Pareto front)")
    axes.plot(walls.values(), heights.values(), "o", color="0.6", markersize=3)
    for number, ladder in enumerate(plan.ladders):
        points = [p for p in plan.path(ladder, found.center) if p in walls]
        axes.plot([walls[p] for p in points], [heights[p] for p in points],
                  label=ladder.name, **style(number))
        for point in (p for p in points if p != found.center):
            axes.annotate(plan.rung_label(ladder, point), (walls[point], heights[point]), (4, 3),
                          fontsize=6, textcoords="offset points", color=colour(number))
    if found.center in walls:
        axes.plot(walls[found.center], heights[found.center], "o", markersize=11, zorder=5,
                  markerfacecolor="none", color="black", label="the run that all ladders share")


def style(number):
    return {"color": colour(number), "marker": marker(number), "markersize": 4, "linewidth": 1.2}


def ladder_panel(axes, plan, found, number):
    """One measure along one ladder: values less the centre's, the limit as a
    line with the band of its uncertainty."""
    unit, factor = scale_of(found)
    ladder, part = plan.ladders[number], found.parts[number]
    center = found.values[found.center]
    points = [p for p in plan.path(ladder, found.center) if p in found.values]
    x = [as_number(plan.value(p, ladder.keys[0])) for p in points]
    if not all(x) or min(x) < 0 or len(set(x)) < len(x):  # words; 0: automatic
        x = [plan.rung_label(ladder, p) for p in points]
    else:
        axes.set(xscale="log", xlim=padded(x))
        log_ticks(axes.xaxis, *axes.get_xlim(), short=True)
    pairs = sorted(zip(x, points), key=lambda pair: as_number(str(pair[0])) or 0)
    if found.from_file:
        axes.axhline(factor * (found.right - center), color="black", linewidth=0.9,
                     linestyle=DOTTED)
    if part.limit is not None:
        axes.axhspan(factor * (part.change - part.uncertainty),
                     factor * (part.change + part.uncertainty),
                     color=colour(number), alpha=0.15, linewidth=0)
        axes.axhline(factor * part.change, color=colour(number), linewidth=0.9, linestyle=DASHED)
    axes.errorbar([a for a, _ in pairs], [factor * (found.values[p] - center) for _, p in pairs],
                  [factor * found.noise[p] for _, p in pairs], capsize=2, **style(number))
    axes.set(xlabel=ladder.name.replace("/", "/\n"), ylabel=f"change [{unit or '1'}]")


def offsets_panel(axes, plan, scatters, measure, direction):
    """Differences from the mean, or the right value, against the grid's place:
    the direction in which they fall on a line is the one that matters."""
    for s in (s for s in scatters if s.measure == measure):
        unit, factor = scale_of(s)
        number = plan.points.index(s.point)
        axes.plot([sample.moved[direction] for sample in s.samples], factor * (s.values - s.base),
                  linestyle="none", markersize=4, marker=marker(number), color=colour(number),
                  label=plan.label(s.point))
        axes.set(xlabel=f"grid moved along {'xyz'[direction]} [h]",
                 ylabel=f"{measure.text}, difference [{unit or '1'}]")
    axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
