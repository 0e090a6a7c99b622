# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Each ladder alone: by how much the results change along it."""
from morula.scene import as_number
from morula.style import colour, log_ticks, marker, padded, plt

from .limits import ROUNDING
from .report import pretty


def alone_figure(findings, estimates):
    """A row for every measure, a column for every ladder, one scale a row: what
    matters is what is steep."""
    ladders = findings.plan.ladders
    figure, panels = plt.subplots(
        len(estimates), len(ladders), squeeze=False, sharey="row",
        figsize=(1.6 + 1.9 * len(ladders), 0.9 + 1.75 * len(estimates)))
    for row, estimate in zip(panels, estimates):
        unit, factor = scale_of(estimate)
        row[0].set_ylabel(f"{estimate.measure.text}\n[{unit}]")
        for number, axes in enumerate(row):
            panel(axes, findings.plan, estimate, number, factor)
        low, high = change_limits(estimate, factor)
        row[0].set_ylim(low - 0.12 * (high - low), high + 0.12 * (high - low))
    for axes, ladder in zip(panels[-1], ladders):
        axes.set_xlabel(ladder.name.replace("/", "/\n")
                        if len(ladder.keys) == 1
                        else ladder.name.replace(" and ", "\n"))
    legend = "dashed: limit of the ladder, with its uncertainty"
    if estimates[0].from_file:
        legend += "; dotted: the reference file"
    figure.suptitle(f"{findings.request.scene.name} at day "
                    f"{estimates[0].time:g}: change against the run that all "
                    f"ladders share ({legend})", fontsize=9)
    figure.tight_layout()
    return figure


def scale_of(estimate):
    if estimate.measure.unit != "um" and abs(estimate.right) > ROUNDING:
        return "%", 100 / abs(estimate.right)
    return pretty(estimate.measure.unit) or "1", 1.0


def change_limits(estimate, factor):
    """Of all values and limits on the ladders; their bands may go beyond."""
    center = estimate.values[estimate.center]
    changes = [value - center for value in estimate.values.values()]
    changes += [estimate.right - center] if estimate.from_file else []
    changes += [part.change for part in estimate.parts if part.limit]
    low, high = factor * min(changes), factor * max(changes)
    return (low, high) if high > low else (low - 1, high + 1)


def panel(axes, plan, estimate, number, factor):
    """One measure along one ladder: values less the centre's, the limit as a
    line with the band of its uncertainty."""
    ladder, part = plan.ladders[number], estimate.parts[number]
    center = estimate.values[estimate.center]
    points = [p for p in plan.path(ladder, estimate.center)
              if p in estimate.values]
    x = place_rungs(axes, plan, ladder, points)
    pairs = sorted(zip(x, points), key=lambda pair: pair[0])
    axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    if estimate.from_file:
        axes.axhline(factor * (estimate.right - center), color="black",
                     linewidth=0.9, linestyle=(0, (1, 1.5)), zorder=1)
    if part.limit is not None:
        draw_limit(axes, part, factor, colour(number))
    axes.errorbar([a for a, _ in pairs],
                  [factor * (estimate.values[p] - center) for _, p in pairs],
                  [factor * estimate.difference_noise[p] for _, p in pairs],
                  color=colour(number), marker=marker(number), markersize=4,
                  linewidth=1.2, capsize=2)
    if estimate.center in points:
        axes.plot(x[points.index(estimate.center)], 0, "o", markersize=9,
                  markerfacecolor="none", color="black", markeredgewidth=1.1)


def draw_limit(axes, part, factor, shade):
    low, high = (factor * (part.change + sign * part.uncertainty)
                 for sign in (-1, 1))
    axes.axhspan(low, high, color=shade, alpha=0.15, linewidth=0)
    axes.axhline(factor * part.change, color=shade, linewidth=0.9,
                 linestyle=(0, (5, 3)))


def place_rungs(axes, plan, ladder, points):
    """Where the points go along the axis: by the number of the first key, or
    side by side where that is no number, means 'automatic' (0), or is the same
    on several rungs."""
    numbers = [as_number(plan.value(p, ladder.keys[0])) for p in points]
    if None in numbers or 0 in numbers or len(set(numbers)) < len(numbers):
        words = [plan.rung_label(ladder, p) for p in points]
        order = (sorted(words, key=float) if None not in map(as_number, words)
                 else words)
        long = sum(map(len, words)) > 20
        axes.set_xticks(range(len(order)), order, fontsize=7,
                        rotation=30 if long else 0,
                        ha="right" if long else "center")
        return [order.index(word) for word in words]
    if max(numbers) > 3 * min(numbers) > 0:
        axes.set_xscale("log")
        axes.set_xlim(*padded(numbers))
        log_ticks(axes.xaxis, *axes.get_xlim(), short=True)
    return numbers
