#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Draws apex, iterations and condition over the grid's offset.

    contrib/upkeep/cases hard/cuts --full
    tests/hard/draw_cuts.py output/hard/full/cuts doc/images/hard/cuts.png
"""
import sys
from pathlib import Path

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot

from tests.common.results import read_csv

SWEEPS = {"disc-paper-s-keys-y": ("the paper's clamp, y", "C1", "o-"),
          "disc-y": ("consistent clamp, y", "C0", "o-"),
          "disc-diagonal": ("consistent clamp, diagonal", "C2", "s-"),
          "disc-no-extension": ("no extension, diagonal", "0.4", "x--")}
STEPS = 2


def read(directory):
    """(offset in h, apex in µm, linear iterations, condition) of a run; what a
    failed run lacks is NaN."""
    rows = read_csv(directory / "ranks-1/statistics.csv")
    condition = read_csv(directory / "ranks-1/condition.csv")["condition"]
    done = rows["step"][-1] == STEPS
    return (int(directory.name[-2:]) / 20,
            rows["ymax"][-1] if done else numpy.nan,
            rows["linear_iterations"].sum() if done else numpy.nan,
            condition.max())


def main(runs, file):
    figure, axes = pyplot.subplots(1, 3, figsize=(11, 3.4), dpi=100)
    for name, (label, colour, style) in SWEEPS.items():
        found = numpy.array([read(d) for d in sorted(
            Path(runs).glob(name + "-[0-9][0-9]"))])
        for axis, column in zip(axes, found.T[1:]):
            axis.plot(found[:, 0], column, style, color=colour, label=label,
                      markersize=4)
    for axis, title in zip(axes, ("apex [µm]", "linear iterations",
                                  "condition estimate")):
        axis.set_title(title)
        axis.set_xlabel("offset of the grid / h")
    axes[1].set_yscale("log")
    axes[2].set_yscale("log")
    axes[0].ticklabel_format(useOffset=False)
    figure.legend(*axes[0].get_legend_handles_labels(), ncol=4,
                  loc="lower center", frameon=False)
    figure.tight_layout(rect=(0, 0.08, 1, 1))
    figure.savefig(file)


if __name__ == "__main__":
    main(*sys.argv[1:])
