# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/growth-plate.prm, six days of a narrow one: how fast the plate
grows, and which part of that is hypertrophy."""
import numpy

from tests.common.program import TESTS

SCENE = TESTS.parent / "prm/examples/growth-plate.prm"
PROLIFERATING, HYPERTROPHIC, BONE = range(3)
HEIGHT = 300.0  # um, of the proliferating zone
RATE = numpy.log(2) / 1.2875  # 1/day
LONGER = 2.44  # how much longer hypertrophy makes a cell


def between(cells, lower, upper):
    """Where the zone of one type ends and that of the next begins."""
    y = cells["y"]
    return (y[cells["type"] == lower].max() + y[cells["type"] == upper].min()) / 2


def test_numbers(runs):
    run = runs.run("plate", SCENE, {"Tissue/Size": "100, 300", "Time/End time": 6,
                                    "Output/Formats": "csv"})
    steady = run.statistics[run.statistics["time"] > 2 - 1e-9]
    velocity = numpy.polyfit(steady["time"], steady["ymax"], 1)[0]
    assert abs(velocity / (RATE * HEIGHT * LONGER) - 1) < 0.02

    # Hypertrophy makes the tissue faster from the one zone to the next.
    cells = [run.cells(i) for i, time in enumerate(run.times) if time > 2 - 1e-9]
    ends = numpy.array([[between(c, PROLIFERATING, HYPERTROPHIC), between(c, HYPERTROPHIC, BONE)]
                        for c in cells])
    heights = numpy.stack([ends[:, 0], ends[:, 1] - ends[:, 0]])
    mean = heights.mean(axis=1)
    assert abs(heights / mean[:, None] - 1).max() < 0.05
    # What doc/theory.md (10.7) says of growth along an axis has been relaxed.
    assert max(abs(c["sigma_xy"]).max() for c in cells) < 0.1
    share = 1 - RATE * mean[0] / velocity
    assert abs(share - (1 - 1 / LONGER)) < 0.03
