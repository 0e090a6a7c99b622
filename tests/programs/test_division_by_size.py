# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that divide by size: of their size, and without the warning of cells that are
too long."""
import numpy

from tests.common.program import TESTS

SCENE = TESTS.parent / "prm/examples/elongating-axis.prm"
SHORT = {"Time/End time": 1.2, "Time/Step": 0.1, "Output/Formats": "csv", "Output/Interval": 0}
TOO_LONG = "cells are longer than half of Grid/Spacing"
PLATE = {"Time/End time": 1, "Time/Step": 0.25, "Tissue/Shape": "box", "Tissue/Size": "60, 60, 30",
         "Tissue/Cell spacing": 10, "Grid/Spacing": 30, "Grid/Points per cell": 2,
         "Material/Relaxation time": 0.1,
         "Growth/Law": "rate", "Growth/Rate/Rate": "normal(1, 0.1)", "Growth/Rate/Share along": 0,
         "Growth/Rate/Direction": "0; 0; 1", "Division by size/Volume": 1440,
         "Division by size/Noise": 0.1, "Output/Formats": "none"}


def test_in_3d_with_points_on_ranks(runs):
    """Cells of several points divide alike on any ranks."""
    one, two = (runs.run(f"plate-{ranks}", PLATE, ranks=ranks) for ranks in (1, 2))
    assert len(one.lineage) > 2 * one.statistics["cells"][0]
    names = ["id", "parent", "generation", "birth_time"]
    assert one.lineage.table[names].equals(two.lineage.table[names])
    assert TOO_LONG not in one.said


def test_cells_keep_their_size(runs):
    run = runs.run("axis", SCENE, SHORT)
    assert TOO_LONG not in run.said
    last = run.statistics.iloc[-1]
    # Columns of cells, 8 um wide, grow along the axis.
    ramp = numpy.clip((numpy.arange(4, 200, 8) - 100) / 40, 0, 1)
    volume = 96 * 8 * numpy.exp(1.2 * 1.2 * ramp).sum()
    assert abs(last["total_volume"] / volume - 1) <= 0.02
    # Each cell has between a half and the whole of a noisy 128 um^2.
    assert run.cells(-1)["volume"].between(0.5 * 128 * 0.65, 128 * 1.4).all()
    assert last["min_cells_per_spacing"] > 2


def test_without_it_cells_get_long(runs):
    said = runs.run("long", SCENE, {**SHORT, "Division by size/Volume": 0,
                                    "Division by size/Noise": 0}).said
    assert TOO_LONG in said
    assert "Division by size/Volume" in said
