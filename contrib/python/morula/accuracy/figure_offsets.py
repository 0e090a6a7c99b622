# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The results against where the grid lies."""
from morula.style import colour, marker, plt

from .limits import ROUNDING
from .report import pretty


def offsets_figure(findings, time):
    """A row for every measure, a column for every direction: the direction in
    which the points fall on a line is the one that matters."""
    request, plan = findings.request, findings.plan
    directions = "xyz"[:request.scene.dimension]
    rows = {measure: [s for s in findings.scatters
                      if s.measure == measure and s.time == time]
            for measure in request.measures}
    figure, panels = plt.subplots(
        len(rows), len(directions), squeeze=False, sharex=True, sharey="row",
        figsize=(2.0 + 2.6 * len(directions), 1.3 + 1.9 * len(rows)))
    for row, (measure, there) in zip(panels, rows.items()):
        row[0].set_ylabel(f"{measure.text}\n[{scale_of(there)[0]}]")
        for number, axes in enumerate(row):
            for s in there:
                draw(axes, plan, s, number, scale_of(there)[1])
            axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    for axes, direction in zip(panels[-1], directions):
        axes.set_xlabel(f"grid moved along {direction} [h]")
    handles, labels = panels[0][0].get_legend_handles_labels()
    if len(plan.points) > 1:
        figure.legend(handles, labels, loc="lower center", ncols=2)
    against = ("against the reference file" if request.reference
               else "against the mean")
    figure.suptitle(f"{request.scene.name} at day {time:g}: difference "
                    f"{against} at {request.n_offsets} grid offsets",
                    fontsize=9)
    lines = (len(plan.points) + 1) // 2 if len(plan.points) > 1 else 0
    figure.tight_layout(rect=(0, 0.26 * lines / figure.get_figheight(), 1, 1))
    return figure


def scale_of(there):
    """Lengths in um, all else in per cent, as in the tables."""
    base = abs(there[0].base) if there else 0.0
    unit = there[0].measure.unit if there else ""
    if unit != "um" and base > ROUNDING:
        return "%", 100 / base
    return pretty(unit) or "1", 1.0


def draw(axes, plan, scatter, direction, factor):
    number = plan.points.index(scatter.point)
    axes.plot([sample.moved[direction] for sample in scatter.samples],
              factor * (scatter.values - scatter.base), linestyle="none",
              marker=marker(number), markersize=4, color=colour(number),
              label=plan.label(scatter.point))
