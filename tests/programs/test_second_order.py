# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is of second order in the step, and what a run says of its error in time:
doc/theory.md, section 5.11."""
import re

import numpy as np
import pytest
from morula.error_in_time import error_in_time

from tests.common.program import TESTS, assert_same_run

EXAMPLES = TESTS.parent / "prm/examples"
QUIET = {"Output/Formats": "csv", "Output/Interval": 0}
BOX = {**QUIET, "Dimension": 2, "Tissue/Shape": "box", "Tissue/Cell spacing": 5}
SHEET = {**BOX, "Time/End time": 1.5, "Tissue/Size": "100, 100", "Grid/Spacing": 25}
CYCLE = "Proliferation/Cell cycle/"
WAITING = {**SHEET, "Proliferation/Law": "cell cycle", CYCLE + "Duration": 1,
           CYCLE + "G0 exit rate": "200*(t > 0.5)"}
STRIP = {**BOX, "Time/End time": 1, "Time/Step": 0.1, "Tissue/Size": "200, 40",
         "Grid/Spacing": 20, "Fields/a/Time": "transient", "Fields/a/Diffusion": 100,
         "Fields/a/Consumption": 2, "Fields/a/Initial": 5, "Fields/b/Time": "transient",
         "Fields/b/Diffusion": 100, "Fields/b/Production": "2*a"}
# Every column that steps compare.
NEST = {"Output/Formats": "csv", "Output/Interval": 0.4, "Solver/Newton tolerance": 1e-11,
        "Dimension": 2, "Time/End time": 0.8, "Time/Step": 0.1, "Tissue/Shape": "sphere",
        "Tissue/Radius": 60, "Tissue/Cell spacing": 8, "Grid/Spacing": 25,
        "Material/Young's modulus": "1 + (type == leaf)",
        "Material/Relaxation time": 0.2, "Fields/Names": "food", "Fields/food/Diffusion": 2000,
        "Fields/food/Consumption": 2, "Fields/food/Fixed where": 1, "Fields/food/Value": 1,
        "Fields/food/Initial": 1, "Cell types/Names": "stem, leaf",
        "Cell types/stem/Transitions/To leaf": "3*max(0, pressure) + food",
        "Growth/Law": "rate", "Growth/Rate/Rate": "0.8*food*max(0, 1 - pressure)",
        "Growth/Rate/Direction": "gradient of food", "Growth/Rate/Share along": 0.6,
        "Growth/Rate/Homeostasis": 0.2, "Proliferation/Law": "cell cycle",
        CYCLE + "Duration": 0.4, CYCLE + "G0 exit rate": "2*food",
        CYCLE + "Size checkpoint": 0.98, "Death/Rate": "0.3*max(0, 1 - food)",
        "Death/Shrinking time": "0.2*(abs(x) > 6 || t < 0.5)",
        "Death/When": "abs(x) < 6 && t >= 0.5"}


@pytest.mark.parametrize("step", [0.25, 0.125])
def test_wait_that_jumps(runs, step):
    """A rate of leaving G0 has the time of the middle of a step. It jumps at day 0.5;
    cells divide half a day after their onset."""
    births = runs.run("jump", WAITING, {"Time/Step": step}).lineage.birth_time
    assert abs(births[births > 0].min() - 1) <= 1e-3


@pytest.mark.parametrize("names", ["a, b", "b, a"])
@pytest.mark.parametrize("back", [0, 1])
def test_order_of_fields(runs, names, back):
    """a becomes b, or each the other: nothing is lost, in any order."""
    last = runs.run("fields", STRIP, {
        "Fields/Names": names, "Fields/b/Consumption": back,
        "Fields/a/Production": f"{back}*b" if back else 0}).statistics.iloc[-1]
    assert abs(last["a_mean"] + last["b_mean"] - 5) <= 5e-8
    # Implicit Euler of a' = -2 a + back (5 - a).
    rest = 5 * back / (2 + back)
    assert abs(last["a_mean"] - rest - (5 - rest) * (1 + 0.1 * (2 + back))**-10) <= 5e-8


def test_growth_under_stress(runs):
    """The surface's way at the scene's own step is that of short ones."""
    ways, errors = {}, {}
    for step in (0.4, 0.2, 0.05):
        run = runs.run("stress", EXAMPLES / "growth-under-stress.prm", {
            **QUIET, "Time/End time": 2, "Time/Step": step,
            "Tissue/Cell spacing": 20, "Grid/Spacing": 50})
        volume = run.statistics["total_volume"]
        ways[step] = volume.iloc[-1] - volume[0]
        errors[step] = error_in_time(run.statistics)
        assert "error in time" in run.said
    assert abs(ways[0.2] / ways[0.05] - 1) < 5e-3
    # What it says falls with the step, and is of the error's order.
    assert errors[0.4] > 2 * errors[0.2]
    assert errors[0.2] > 4 * errors[0.05]


def test_drop_in_steps_of_its_relaxation_time(runs):
    coarse, fine = (runs.run("drop", EXAMPLES / "rounding-drop.prm", {
        **QUIET, "Time/End time": 0.8, "Time/Step": step}).statistics["xmax"]
        for step in (0.1, 0.02))
    assert abs((coarse[0] - coarse.iloc[-1]) / (fine[0] - fine.iloc[-1]) - 1) < 0.02


def test_a_cut_opens_when_it_is_due(runs):
    """At the end of the step that ends at day 1: the first equilibrium with
    the cut is that of the next step."""
    run = runs.run("cut", EXAMPLES / "cut-and-opening.prm", {
        **QUIET, "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Tissue/Radius": 200,
        "Death/When": "t >= 1 && X > 0 && abs(Y) < 30"})
    table = run.statistics
    row = int(np.flatnonzero(table["removed"] > 0)[0])
    assert abs(table["time"][row] - 1) <= 5e-8
    assert {*run.events["time"]} == {1.0}
    assert table["mean_energy_density"][row + 1] < 0.7 * table["mean_energy_density"][row]


@pytest.mark.parametrize("tolerance", [pytest.param(0, marks=pytest.mark.release), 2e-3])
def test_the_same_on_ranks_and_resumed(runs, tolerance):
    """With every column that steps compare, and steps that choose their
    length."""
    keys = {"Time/Tolerance": tolerance}
    one = runs.run("one", NEST, keys)
    table = one.statistics
    assert table["step_error"].max() > 0
    assert table["dividing"].sum() > 20
    assert table["deaths"].sum() > 5
    assert table["cells_leaf"].iloc[-1] > 20
    if tolerance:
        assert table["dt"][1] < 0.1 / 8
        assert len({*np.round(table["dt"][1:], 9)}) > 2
        cut = int(np.flatnonzero(table["removed"] > 3)[0])
        assert table["dt"][cut + 1] < 0.1 / 8
    for ranks in (2, 3) if runs.options.ring == "release" else (3,):
        several = runs.run("several", NEST, keys, ranks=ranks).statistics
        for name in ("cells", "dividing", "deaths", "cells_leaf"):
            np.testing.assert_array_equal(table[name], several[name])
        for name in ("dt", "total_volume", "grown_volume"):
            np.testing.assert_allclose(table[name], several[name], rtol=1e-9)
    assert_same_run(one, runs.resumed("parts", NEST, keys, 0.4))


def test_nothing_is_kept_where_only_time_matters(runs):
    """No column of statistics.csv, no error in time."""
    run = runs.run("time", SHEET, {"Growth/Law": "rate", "Growth/Rate/Rate": "0.3*t",
                                   "Time/Step": 0.25})
    assert "step_error" not in run.statistics.columns
    assert re.search("error in time +none to estimate", run.said)
    assert error_in_time(run.statistics) is None
