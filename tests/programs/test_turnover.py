# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue whose cells divide and die, with a surface that is made anew:
doc/theory.md, sections 4.5 and 6.9.
"""
import numpy as np

from tests.common.program import TESTS, assert_same_run

EXAMPLE = TESTS.parent / "prm/examples/turnover.prm"
DISC = {"Dimension": 2, "Tissue/Radius": 150, "Output/Formats": "csv", "Random seed": 4}
SPACING = 12.5  # L_p, um


def check_surface(surface, cells):
    """It is closed, encloses the cells, has about as many patches as the
    first one on its length, and is round."""
    x, n = surface[["x", "y"]].to_numpy(), surface[["nx", "ny"]].to_numpy()
    area = surface["area"].to_numpy()
    volume = cells["volume"].sum()
    assert np.linalg.norm(area @ n) < 0.01 * area.sum()
    assert abs((area[:, None] * n * x).sum() / 2 / volume - 1) <= 0.03
    assert 0.5 < len(area) * SPACING / area.sum() < 2
    assert area.sum() / np.sqrt(4 * np.pi * volume) < 1.5


def test_ten_days(runs):
    """As many cells die as are born in the mean. Nothing regulates their
    number: its standard deviation is that of the critical age-dependent
    branching process, sqrt(0.707 N t/day), 2.5 times sqrt(N) here."""
    run = runs.run("ten", EXAMPLE, {**DISC, "Output/Interval": 2})
    table = run.statistics
    begin, last = table[table["time"] > 1].iloc[0], table.iloc[-1]
    assert table["deaths"].sum() > 4 * begin["cells"]
    assert abs(last["cells"] - begin["cells"]) < 3 * np.sqrt(0.707 * begin["cells"] * 9)
    # a cell is as large as it was
    size = table["total_volume"] / table["cells"]
    assert abs(size.iloc[-30:].mean() / size[10:40].mean() - 1) < 0.02
    assert abs(1 - table["total_volume"] / table["grown_volume"]).max() < 0.02
    assert {*table["connected_tissues"]} == {1}
    for number in range(1, 6):
        check_surface(run.surface(number), run.cells(number))


def test_ranks_and_resume(runs):
    keys = {**DISC, "Time/End time": 2, "Output/Interval": 1, "Time/Step": 0.125}
    whole = runs.run("whole", EXAMPLE, keys)
    assert_same_run(whole, runs.resumed("parts", EXAMPLE, keys, 1))
    two = runs.run("two", EXAMPLE, keys, ranks=2)
    one, other = (run.surface(-1) for run in (whole, two))
    assert len(one) == len(other)
    np.testing.assert_allclose(one["area"].sum(), other["area"].sum(), rtol=1e-6)
    assert {*whole.cells(-1)["id"]} == {*two.cells(-1)["id"]}
