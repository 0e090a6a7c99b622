# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fields in whole runs: resumed, stopped, in pictures; and
prm/examples/oxygen-limited-spheroid.prm, a small one."""
import numpy
import pytest
from morula.report import curves

from tests.common.program import TESTS, assert_same_run

SCENE = TESTS / "programs/small-cube.prm"
SPHEROID = TESTS.parent / "prm/examples/oxygen-limited-spheroid.prm"
FIELDS = {"Fields/Names": "oxygen, signal", "Fields/oxygen/Diffusion": "1e5",
          "Fields/oxygen/Consumption": "6e4/(1 + oxygen)", "Fields/oxygen/Fixed where": "Z > 59",
          "Fields/oxygen/Value": "100 - 40*t", "Fields/oxygen/Initial": 100,
          "Fields/signal/Time": "transient", "Fields/signal/Diffusion": "500*(1 + (X > 0))",
          "Fields/signal/Production": "hill(oxygen, 40, 2)", "Fields/signal/Consumption": 0.5,
          "Fields/signal/Transfer": "20*(X > 29)",
          "Proliferation/Cell cycle/G0 exit rate": "2*hill(oxygen, 40, 2)",
          "Proliferation/Cell cycle/Division axis": "gradient of oxygen",
          "Solver/Newton tolerance": 1e-10}


def test_resumed_run_is_the_same(runs):
    whole = runs.run("whole", SCENE, FIELDS)
    assert_same_run(whole, runs.resumed("resumed", SCENE, FIELDS, 0.5))
    cells = whole.cells(2)
    assert numpy.ptp(cells["oxygen"]) > 10
    assert numpy.ptp(cells["signal"]) > 0.05


def test_resumed_from_the_start(runs):
    """A first step that could not be done: what was solved at t = 0 stands
    in the snapshot, and is not solved again."""
    keys = {**FIELDS, "Proliferation/Cell cycle/Start": "together", "Time/Smallest step": 0.125,
            "Proliferation/Cell cycle/G0 exit rate": 1}
    whole = runs.run("together", SCENE, keys)
    failed = runs.run("failed", SCENE, {**keys, "Solver/Largest gap": 1e-15}, code=2)
    assert len(failed.statistics) == 1
    assert_same_run(whole, runs.run("failed", SCENE, keys, "--resume"))


def test_all_cells_die(runs):
    """The fields of no cells are 0, as all else of them."""
    run = runs.run("dead", SCENE, {**FIELDS, "Death/When": "t > 0.3", "Death/Shrinking time": 0})
    assert "Finished: all cells are dead" in run.said
    rows = run.statistics
    assert rows["cells"].iloc[-1] == 0
    for field in ("oxygen", "signal"):
        values = rows[[f"{field}_{what}" for what in ("min", "mean", "max")]]
        assert numpy.isfinite(values).all().all()
        assert (values.iloc[-1] == 0).all()
        assert values[f"{field}_mean"].iloc[-2] > 0


def test_no_value_any_more_in_mid_run(runs):
    """The run ends with its state, and what is wrong."""
    run = runs.run("no-value", SCENE, {**FIELDS, "Fields/signal/Consumption": "0.3 - t"}, code=2)
    assert "Fields/signal/Consumption = '0.3 - t'" in run.said
    assert "The state is saved in snapshot.h5." in run.said
    assert (run.directory / "snapshot.h5").is_file()


@pytest.mark.parametrize("consumption, code, word", [
    ("t < 0.3", 2, "Without a sink a steady field has no level"),
    ("1e3*(oxygen > 50)", 0, "the field 'oxygen' still changed by")])
def test_no_steady_state_in_mid_run(runs, consumption, code, word):
    keys = {**FIELDS, "Fields/oxygen/Consumption": consumption}
    if code:
        keys = {"Fields/Names": "oxygen", "Fields/oxygen/Diffusion": "1e5",
                "Fields/oxygen/Consumption": consumption}
    assert runs.run(f"steady-{code}", SCENE, keys, code=code).said.count(word) == 1


def test_explained(runs):
    text = runs.explain(SCENE, FIELDS)
    for words in ("fields                  Names = oxygen, signal",
                  "oxygen/Time = steady, oxygen/Diffusion = 1e5 um^2/day",
                  "Fixed where = Z > 59", "Value = 100 - 40*t", "Transfer = 20*(X > 29) um/day"):
        assert words in text


def test_spheroid(runs):
    """A small one: a rim that grows around cells at rest and a core."""
    run = runs.run("spheroid", SPHEROID, {"Tissue/Cell spacing": 20, "Grid/Spacing": 60,
                                          "Output/Formats": "csv"})
    assert run.field_names == ("oxygen",)
    assert "The field oxygen" in [curve.title for curve in curves.results(run)]
    rows, cells = run.statistics, run.cells(-1)
    # In the core, where next to nothing is left.
    assert (rows["oxygen_clipped"] / rows["cells"]).max() < 0.06
    # Once in each configuration: that of t = 0 is that of the first step.
    assert run.timings.loc["fields", "calls"] == len(rows) - 1
    r = numpy.linalg.norm(cells[["x", "y", "z"]], axis=1)
    rim, rest, core = (r[cells["type"] == i].mean() for i in range(3))
    assert rim > rest > core
    growth = numpy.diff(numpy.log(rows["total_volume"]))
    assert growth[0] > 1.1 * growth[-1]
