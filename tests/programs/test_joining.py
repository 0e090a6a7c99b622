# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies that share splines, from the start or as they grow: the run says so,
once."""
import re

import pytest

SCENE = {"Dimension": 2, "Time/End time": 1, "Time/Step": 0.1, "Tissue/Shape": "points",
         "Grid/Spacing": 25, "Growth/Law": "isotropic", "Output/Formats": "csv",
         "Output/Interval": 0, "Output/Snapshot interval": 0.1}
MESSAGE = re.compile(r"Warning: at t = ([0-9.]+) day the tissue has (\d+) connected parts after (\d+)\. "
                     r"If none has died, parts have come within a grid spacing")
AT_START = re.compile(r"the tissue is (\d+) bodies, of which the grid makes (\d+):")


def bodies(runs, gaps, rate):
    """Bodies of 10 x 10 cells of 10 µm, with these gaps (µm) between them along x."""
    rows, left = ["x,y"], 0.0
    for gap in (0.0, *gaps):
        left += gap
        rows += [f"{left + 10 * i + 5},{10 * j + 5}" for i in range(10) for j in range(10)]
        left += 100.0
    return {**SCENE, "Tissue/Points file": runs.write("cells.csv", "\n".join(rows) + "\n"),
            "Growth/Isotropic/Stretch": f"1 + {rate} * t"}


def warnings(run):
    """Time, and how many parts there are and were, of each."""
    return [[float(number) for number in one] for one in MESSAGE.findall(run.said)]


@pytest.mark.parametrize("ranks", [1, 2])
def test_once_with_time(runs, ranks):
    """Two joints: the later one is not told of."""
    run = runs.run("joins", bodies(runs, (60.0, 70.0), 0.6), ranks=ranks)
    (t, now, before), = warnings(run)
    # each body grows by 30 t µm on either side
    assert 0 < 60 - 60 * t < 50
    assert (now, before) == (2, 3)
    assert len(MESSAGE.findall((run.directory / "log.txt").read_text())) == 1


def test_not_of_bodies_that_stay_apart(runs):
    assert warnings(runs.run("apart", bodies(runs, (60.0,), 0.05))) == []


@pytest.mark.parametrize("gaps, counts", [
    ((20.0, 70.0), [("3", "2")]), ((20.0,), [("2", "1")]), ((60.0,), []), ((10.0,), [])])
def test_from_the_start(runs, gaps, counts):
    """Bodies that share a piece before anything has moved: of three one
    stands alone. A gap of a cell is no gap, and makes no body."""
    assert AT_START.findall(runs.explain(bodies(runs, gaps, 0.0), {"Grid/Spacing": 30})) == counts


def test_resumed(runs):
    """The first step after --resume has nothing to compare with."""
    assert len(warnings(runs.resumed("parts", bodies(runs, (60.0,), 0.6), {}, 0.2))) == 1
