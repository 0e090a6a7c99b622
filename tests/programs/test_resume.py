# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Interrupted and resumed runs against the run that nothing interrupted.

On the same number of ranks they agree bit for bit, on others in the lineage.
"""
import json
import re

import h5py
import pytest

from tests.common.program import TESTS, assert_same_columns, assert_same_file, assert_same_run

SCENE = TESTS / "programs/small-cube.prm"
END, INTERVAL = "Time/End time", "Output/Interval"
TIGHT = {"Solver/Newton tolerance": 1e-10}
SHEET = {"Proliferation/Cell cycle/Size checkpoint": 0.9,
         "Boundary conditions/Fixed where": "Z <= 0", "Solver/Newton tolerance": 1e-12}
REFINED = {**TIGHT, "Tissue/Refine surface": "true", "Grid/Spacing": 32,
           "Tissue/Boundary points": 96}


@pytest.fixture(scope="module")
def whole(runs):
    return runs.run("whole", SCENE)


@pytest.fixture
def half(runs):
    """The scene until half of its time."""
    return runs.run("half", SCENE, {END: 0.5}, "--replace")


@pytest.mark.parametrize("name, keys, ranks", [
    pytest.param("sheet", SHEET, 2, marks=pytest.mark.release),
    # In the paper's form held points keep a cell, which may not be the nearest one.
    ("carriers", {**SHEET, "Method": "paper"}, 1), ("refined", REFINED, 1),
    # Their tables go on, too.
    ("tables", {"Output/Condition estimate": "true", "Output/Newton trace": "true"}, 1)])
def test_longer_end_time(runs, name, keys, ranks):
    run = runs.run(name, SCENE, keys, ranks=ranks)
    assert_same_run(run, runs.resumed(f"{name}-parts", SCENE, keys, 0.5, ranks=ranks))
    if name == "carriers":
        with h5py.File(run.directory / "snapshot.h5") as file:
            assert "carrier 1" in str(file["boundary points/columns"][()])
    if name == "refined":  # before and after the interruption
        points = [len(run.surface(i)) for i in range(3)]
        assert points == sorted(set(points))


def test_on_another_number_of_ranks(runs):
    one = runs.run("tight", SCENE, TIGHT)
    runs.run("others", SCENE, {**TIGHT, END: 0.25}, ranks=1)
    runs.run("others", SCENE, {**TIGHT, END: 0.5}, "--resume", ranks=3)
    other = runs.run("others", SCENE, TIGHT, "--resume", ranks=1)
    assert_same_columns(one.directory / "lineage.csv", other.directory / "lineage.csv",
                        dict.fromkeys("xyz", 1e-6))


def test_table_that_begins_late(runs, half):
    run = runs.run("half", SCENE, {"Output/Condition estimate": "true"}, "--resume")
    rows = (run.directory / "condition.csv").read_text().splitlines()[1:]
    assert [row.split(",")[0] for row in rows] == ["5", "6", "7", "8"]


def test_timings(runs):
    """They count on. A snapshot leaves its own writing out: deal.II sums
    up no timer with an open section."""
    run = runs.run("timings", SCENE, {"Output/Snapshot interval": 0.25, "Output/Formats": "none",
                                      END: 0.75})
    calls = run.timings["calls"]
    assert calls["snapshot"] >= 3
    with h5py.File(run.directory / "snapshot.h5") as file:
        saved = file["numbers"].attrs
        assert saved["calls of snapshot"] == calls["snapshot"] - 1
        assert saved["calls of tangent"] == calls["tangent"]
    after = runs.run("timings", SCENE, {}, "--resume").timings["calls"]
    assert after["snapshot"] == calls["snapshot"]  # the last was not paid
    assert after["tangent"] > calls["tangent"]


def test_stop_at_cells(runs):
    keys = {INTERVAL: 0}
    all_of_it = runs.run("ends", SCENE, keys)
    stopped = runs.run("stops", SCENE, {**keys, "Time/Stop at cells": 130})
    cells = stopped.statistics["cells"]
    assert cells.iloc[-2] < 130 <= cells.iloc[-1]
    assert stopped.statistics["time"].iloc[-1] < 1.0
    # stopping wrote an output of its own, at a step end of the whole run
    run = runs.run("stops", SCENE, keys, "--resume")
    assert_same_file(all_of_it.directory / "cells-0001.csv", run.directory / "cells-0002.csv")
    assert_same_file(all_of_it.directory / "lineage.csv", run.directory / "lineage.csv")


@pytest.mark.parametrize("end, keys, times", [
    # a cut last step: the resumed run goes on to the old step ends
    (0.3, {}, [0, 0.125, 0.25, 0.3, 0.375, 0.5, 0.625, 0.75, 0.875, 1]),
    (0.5, {"Time/Step": 0.25}, [0, 0.125, 0.25, 0.375, 0.5, 0.75, 1])])
def test_steps(runs, end, keys, times):
    runs.run("steps", SCENE, {END: end}, "--replace")
    assert list(runs.run("steps", SCENE, keys, "--resume").statistics["time"]) == times


def test_other_output_interval(runs):
    runs.run("outputs", SCENE, {END: 0.5, INTERVAL: 0.125})
    run = runs.run("outputs", SCENE, {INTERVAL: 0.25}, "--resume")
    assert list(run.times) == [0, 0.125, 0.25, 0.375, 0.5, 0.75, 1]


def test_other_format(runs):
    """The new series has no states that are not there."""
    runs.run("formats", SCENE, {END: 0.5, INTERVAL: 0.25})
    run = runs.run("formats", SCENE, {"Output/Formats": "vtu", INTERVAL: 0.25, END: 1}, "--resume")
    for stem in ("cells", "surface"):
        listed = re.findall(r'file="(.*?)"', (run.directory / f"{stem}.pvd").read_text())
        assert listed == [f"{stem}-0003.vtu", f"{stem}-0004.vtu"]


def test_provenance(runs):
    """log.txt begins with what provenance.json says of each part of a run, also once resumed."""
    runs.run("provenance", SCENE, {END: 0.25})
    run = runs.run("provenance", SCENE, {END: 0.375}, "--resume", ranks=2)
    parts = json.loads((run.directory / "provenance.json").read_text())
    assert [part["ranks"] for part in parts] == ["1", "2"]
    assert parts[0]["command"].startswith(f"morula {SCENE} ")
    assert f"'{END}=0.25'" in parts[0]["command"] and "--resume" in parts[1]["command"]
    version = runs.call([runs.options.morula, "--version"]).stdout.split()[1]
    assert {part["version"].split()[0] for part in parts} == {version}
    log = (run.directory / "log.txt").read_text()
    heads = ["".join(f"{name}: {value}\n" for name, value in part.items()) for part in parts]
    assert log.startswith(heads[0]) and log.count(heads[1]) == 1


def test_failure_is_logged(runs):
    run = runs.run("fails", SCENE, {
        "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "if (t > 0.2 && t < 0.3, log(-1), 1)"}, code=2)
    for text in (run.said, (run.directory / "log.txt").read_text()):
        assert "t = 0.125 day" in text
        assert "Growth/Isotropic/Stretch" in text


def test_finished_run(runs, half):
    names = ("statistics.csv", "lineage.csv", "snapshot.h5")
    before = [(half.directory / name).read_bytes() for name in names]
    runs.run("half", SCENE, {END: 0.5}, "--resume")
    assert before == [(half.directory / name).read_bytes() for name in names]
