# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/osborne-crypt.prm, as case 2 of Osborne et al. (2017) has it: eight
days, and in the release all 46."""
import pytest

from tests.common.program import TESTS

SCENE = TESTS.parent / "prm/examples/osborne-crypt.prm"
BEGIN = 3  # day: from then on as at the end


@pytest.mark.parametrize("end", [8, pytest.param(46, marks=pytest.mark.release)])
def test_crypt(runs, end):
    run = runs.run(f"crypt-{end}", SCENE, {"Time/End time": end, "Output/Formats": "csv",
                                           "Output/Interval": 0.25})
    rows = run.statistics[run.statistics["time"] > BEGIN]
    assert rows["held_at_checkpoint"].max() < 10  # of some 100 that divide
    assert abs(rows["total_volume"] / (160 * 120) - 1).max() < 0.1
    shed = run.events[(run.events["event"] == "removal") & (run.events["time"] > BEGIN)]
    assert 7.5 < len(shed) / (24 * (end - BEGIN)) < 9
    up, filled = [], []
    for n, time in enumerate(run.times):
        if time > BEGIN:
            cells = run.cells(n)
            inside = cells[(cells["y"] > 0) & (cells["y"] < 120)]
            filled.append(inside["volume"].sum() / (160 * 120))
            before = run.cells(n - 1).set_index("id")["y"]
            cells = cells[cells["id"].isin(before.index) & cells["y"].between(60, 100)]
            up += [*(cells["y"] - before.loc[cells["id"]].values)]
    assert 0.33 < sum(up) / len(up) / (0.25 * 24 * 10) < 0.5  # cell diameters an hour
    # A row of cells is 8 %; it comes and goes at the top.
    assert sum(filled) / len(filled) == pytest.approx(1, abs=0.03) and min(filled) > 0.92
    assert run.cells(n)["y"].min() > -1
