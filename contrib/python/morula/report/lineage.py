# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Clones: numbers of them, and pictures."""
import numpy as np

from .numbers import number
from .pictures import drawn

MOST = 500  # cells of a clone whose tree is drawn


def summary(run):
    lineage, sizes = run.lineage, run.lineage.clone_sizes
    divisions, largest = (len(lineage) - lineage.founders) // 2, int(sizes.argmax())
    return [
        ("founders", number(lineage.founders)),
        ("cells that ever lived", number(len(lineage))),
        ("divisions", number(divisions)),
        ("cells living at the end", number(len(lineage.living))),
        ("cells that died", number(np.isfinite(lineage.death_time).sum())),
        ("clones that died out", number((sizes == 0).sum())),
        ("founders that never divided", number((sizes == 1).sum())),
        ("mean cells of a clone", number(sizes.mean())),
        ("largest clone", f"{number(sizes[largest])} cells, of founder {largest}"),
        ("latest generation", number(lineage.generation.max()))]


def pictures(run):
    """(title, picture, words)"""
    lineage, sizes = run.lineage, run.lineage.clone_sizes
    generations = lineage.generation[lineage.living]
    for title, values in (("Clones by their living cells", sizes),
                          ("Living cells by generation", generations)):
        if len(values):
            yield title, drawn(lambda axes: histogram(axes, values)), ""
    largest = int(sizes.argmax())
    clone = lineage.clone(largest)
    if len(clone) <= MOST:
        end = run.statistics["time"].iloc[-1]
        yield (f"Tree of founder {largest}, of the largest clone", drawn(
            lambda axes: lineage.plot(largest, axes, end), (4.6, max(2.7, 0.06 * len(clone)))),
            "Colours are generations.")


def histogram(axes, values):
    width = max(1, int(np.ceil((values.max() + 1) / 40)))
    axes.hist(values, np.arange(-0.5, values.max() + 0.5 + width, width), rwidth=0.85)
    axes.xaxis.get_major_locator().set_params(integer=True)
