# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Columns of statistics.csv against time: a line for each combination, with a
band of one standard deviation over the seeds."""
from morula.columns import pretty
from morula.files import replaced
from morula.style import COLOURS, RC, colour, plt

MAX_NAMES = 24  # of combinations beside the panels


def draw(request, ensembles, file):
    """Ensembles without any finished run are left out."""
    shown = [ensemble for ensemble in ensembles if ensemble.runs]
    n = len(request.columns)
    rows = -(-n // 2) if n > 3 else 1
    columns = -(-n // rows)
    with plt.rc_context(RC):
        figure, panels = plt.subplots(rows, columns, squeeze=False, layout="constrained",
                                      figsize=(4.2 * columns + 2.4, 3.6 * rows))
        for axes in panels.flat[n:]:
            axes.remove()
        for axes, measure in zip(panels.flat, request.columns):
            _panel(axes, shown, measure)
        _legend(panels[0, -1], shown)
        figure.suptitle(f"{request.scene.name}: mean, and standard deviation "
                        "over the seeds", fontsize=10)
        with replaced(file) as aside:
            figure.savefig(aside, format="png")
        plt.close(figure)


def _panel(axes, shown, measure):
    for number, ensemble in enumerate(shown):
        times, mean, deviation = ensemble.course(measure)
        ink = (colour(number) if len(shown) <= len(COLOURS) else
               plt.get_cmap("viridis")(0.95 * number / (len(shown) - 1)))
        axes.plot(times, mean, color=ink, linewidth=1.4, label=ensemble.label)
        axes.fill_between(times, mean - deviation, mean + deviation,
                          color=ink, alpha=0.18, linewidth=0)
    name, unit = measure.text.replace("_", " "), pretty(measure.unit)
    axes.set(xlabel="time, day", ylabel=f"{name}, {unit}" if unit else name)


def _legend(axes, shown):
    """Right of the panel."""
    handles, names = axes.get_legend_handles_labels()
    if len(handles) > MAX_NAMES:
        handles = handles[:MAX_NAMES]
        names = names[:MAX_NAMES - 1] + [f"... {len(shown) - MAX_NAMES + 1} " "more, see table.md"]
    axes.legend(handles, names, loc="upper left", bbox_to_anchor=(1.02, 1), fontsize=7)
