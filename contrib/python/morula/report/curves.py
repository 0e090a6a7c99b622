# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The columns of statistics.csv over time, as pictures within the page."""
import io
import re
from dataclasses import dataclass

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (after the backend)
from matplotlib.ticker import ScalarFormatter  # noqa: E402

from . import markup  # noqa: E402
from .growth_fit import fit_growth  # noqa: E402
from .markup import Markup, joined, number, span  # noqa: E402
from .scene import volume_unit  # noqa: E402

# Colours that the page replaces by its own, light or dark.
SERIES = ("#010101", "#020202", "#030303", "#040404", "#050505", "#060606",
          "#090909", "#0a0a0a")
TEXT, GRID = "#070707", "#080808"
RC = {"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 10,
      "axes.spines.top": False, "axes.spines.right": False,
      "axes.edgecolor": TEXT, "axes.labelcolor": TEXT, "text.color": TEXT,
      "xtick.color": TEXT, "ytick.color": TEXT, "legend.frameon": False,
      "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.6,
      "axes.formatter.use_mathtext": True, "axes.axisbelow": True,
      "axes.formatter.limits": (-3, 5), "legend.fontsize": 9}


class TickLabels(ScalarFormatter):
    """Plain text, but for the common power of ten: a report takes 1.4 times as
    long if all labels are formulas."""

    def __call__(self, x, pos=None):
        return (super().__call__(x, pos).removeprefix(r"$\mathdefault{")
                .removesuffix("}$"))


@dataclass(frozen=True)
class Curve:
    """Columns drawn together; `grown` may be exponential."""

    title: str
    unit: str
    columns: dict
    grown: str = ""
    log: bool = False
    zero: bool = False  # the axis begins at zero
    only_steps: bool = False  # not of the initial state


def results(run):
    volume = volume_unit(run)
    curves = [
        Curve("Number of cells", "", {"cells": "cells"}, grown="cells"),
        Curve("Volume", volume, {
            "total_volume": "of the cells, deformed",
            "grown_volume": "of the cells, were they free"},
            grown="total_volume"),
        Curve("Strain energy density", "kPa", {
            "mean_energy_density": "mean, weighted by volume",
            "cell_mean_energy_density": "mean, each cell once"}),
        Curve("Largest strain energy density", "kPa",
              {"max_energy_density": "largest"}),
        Curve("Elastic volume ratio", "", {
            "min_elastic_volume_ratio": "smallest",
            "max_elastic_volume_ratio": "largest"})]
    if run.statistics["dividing"].any():
        curves.append(Curve("Divisions in a step", "",
                            {"dividing": "divisions"}, only_steps=True))
    if run.statistics["held_at_checkpoint"].any():
        curves.append(Curve("Cells held at the size checkpoint", "",
                            {"held_at_checkpoint": "held"}))
    if "dying" in run.statistics:
        curves += [Curve("Dead cells that are still there", "",
                         {"dying": "dead cells"}),
                   Curve("Deaths and removals in a step", "",
                         {"deaths": "deaths", "removed": "removals"},
                         only_steps=True)]
    columns = {f"cells_{name}": name for name in run.type_names}
    if columns and {*columns} <= {*run.statistics}:
        curves.insert(1, Curve("Cells of each type", "", columns, zero=True))
    for name in run.field_names:
        curves.append(Curve(f"The field {name}", "", {
            f"{name}_max": "largest", f"{name}_mean": "mean, by volume",
            f"{name}_min": "least"}, zero=True))
    curves.append(Curve("Extent of the surface", "µm", {
        f"{axis}{end}": f"{axis}, {word}"
        for axis in "xyz"[:run.dimension]
        for end, word in (("min", "least"), ("max", "most"))}))
    return curves


def effort(run):
    curves = [
        Curve("Unknowns", "", {"unknowns": "unknowns"}, only_steps=True,
              zero=True),
        Curve("Iterations in a step", "", {
            "linear_iterations": "linear", "newton_iterations": "Newton"},
            only_steps=True, zero=True),
        Curve("Wall time", "s", {"wall_seconds": "since the start"}),
        Curve("Last residual of a step, relative", "",
              {"residual": "residual"}, only_steps=True, log=True),
        Curve("Length of a step", "day", {"dt": "step"}, only_steps=True,
              zero=True)]
    if "step_error" in run.statistics:
        curves.append(Curve(
            "What the step before missed of growth and flow, relative", "",
            {"step_error": "missed"}, only_steps=True, zero=True))
    return curves


def figure(run, curve):
    """The curve as HTML: picture, words on the fit, the last values."""
    rows = run.statistics[1:] if curve.only_steps else run.statistics
    if not len(rows):
        return Markup("")
    last = rows.iloc[-1]
    fit = fit_growth(rows["time"].to_numpy(), rows[curve.grown].to_numpy()) \
        if curve.grown else None
    picture = draw(rows, curve, fit)
    words = [f"{label}: {number(last[name])} {curve.unit}".strip()
             for name, label in curve.columns.items()]
    caption = f"Day {last['time']:g}: " + "; ".join(words) + "."
    return markup.figure(
        ", ".join(filter(None, (curve.title, curve.unit))), picture,
        Markup(" ").join(filter(None, (caption, words_on(fit, curve)))),
        f"curve-{next(iter(curve.columns))}")


def words_on(fit, curve):
    if not curve.grown:
        return ""
    if fit is None:
        return ("No exponential was fitted: too few steps, or it hardly "
                "grows.")
    where = (f"days {fit.low:g} to {fit.high:g} ({fit.rows} steps, least "
             "squares of the logarithm)")
    if not fit.exponential:
        return (f"Not exponential over {where}: r² = {fit.r2:.5f}, of a "
                f"straight line {fit.r2_line:.5f}.")
    return span("fit", f"Fit over {where}: {fit.factor:.4g} · "
                f"exp({fit.rate:.4f} t/day), r² = {fit.r2:.5f}; of a straight "
                f"line r² = {fit.r2_line:.5f}.")


def draw(rows, curve, fit):
    with plt.rc_context({**RC, "svg.hashsalt": curve.title}):
        canvas, axes = plt.subplots(figsize=(4.6, 2.7), layout="constrained")
        for i, (name, label) in enumerate(curve.columns.items()):
            again, colour = divmod(i, len(SERIES))
            values = rows[name].where(rows[name] > 0) \
                if curve.log else rows[name]
            marker = "o" if len(rows) < 25 else ""
            # a name is no formula, whatever dollars stand in it
            axes.plot(rows["time"], values, color=SERIES[colour],
                      label=label.replace("$", r"\$"), linewidth=1.6,
                      linestyle=":" if again else "-", marker=marker,
                      markersize=3)
        if fit is not None and fit.exponential:
            time = np.linspace(fit.low, fit.high, 100)
            axes.plot(time, fit(time), color=SERIES[1 if len(curve.columns)
                                                    == 1 else 2],
                      label="exponential fit", linewidth=2.2, linestyle="--")
        label_plainly(axes)
        if curve.log and (rows[next(iter(curve.columns))] > 0).any():
            axes.set_yscale("log")
        if curve.zero:
            axes.set_ylim(bottom=0)
        if axes.lines and len(axes.get_legend_handles_labels()[1]) > 1:
            axes.legend(ncols=2 if len(axes.lines) > 3 else 1)
        axes.set_xlabel("day")
        return svg(canvas, curve.title)


def label_plainly(axes):
    """The ticks of both axes, before one becomes logarithmic."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(TickLabels())


def svg(canvas, title):
    """The picture as an element of the page, which gives the colours."""
    stream = io.StringIO()
    canvas.savefig(stream, format="svg", transparent=True,
                   metadata={"Date": None, "Creator": None, "Format": None,
                             "Type": None})
    plt.close(canvas)
    text = stream.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'^<svg [^>]*?(viewBox="[^"]*")[^>]*>',
                  rf'<svg \1 role="img" aria-label="{title}" '
                  'xmlns:xlink="http://www.w3.org/1999/xlink">', text)
    for i, colour in enumerate(SERIES):
        text = text.replace(colour, f"var(--series-{i})")
    return Markup(text.replace(TEXT, "var(--text)")
                  .replace(GRID, "var(--line)"))


def figures(run, curves):
    return joined(figure(run, curve) for curve in curves)
