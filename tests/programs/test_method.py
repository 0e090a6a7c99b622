# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The key Method: what a run does with it, writes of it, and resumes with it;
and that the tools complete a scene as the program does.
"""
import pytest
from morula.prm import parse
from morula.program import Program
from morula.scene import normal

from tests.common.program import assert_same_run, without_wall_time

FORM = "Boundary conditions/Nitsche form"
PENALTY = "Boundary conditions/Nitsche penalty"
CONSISTENT = {FORM: "bounded", PENALTY: "20", "Tissue/Surface cells": "trimmed",
              "Tissue/Refine surface": "true", "Material/Energy per": "grown volume",
              "Material/Volumetric strain": "pooled"}
PAPER = {FORM: "symmetric", PENALTY: "1000", "Tissue/Surface cells": "whole",
         "Tissue/Refine surface": "false", "Material/Energy per": "initial volume",
         "Material/Volumetric strain": "pointwise"}
DISC = {"Dimension": "2", "Time/End time": "2", "Time/Step": "1", "Tissue/Radius": "100",
        "Tissue/Cell spacing": "10", "Grid/Spacing": "40", "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.1*t", "Boundary conditions/Fixed where": "Y <= 0",
        "Output/Interval": "0", "Output/Formats": "csv"}
HEAD = 5  # lines of log.txt on version, date, host, ranks and command
HALF = {"Time/End time": "1"}


def first_line(run):
    return (run.directory / "log.txt").read_text().splitlines()[HEAD]


@pytest.fixture(scope="module")
def discs(runs):
    """The disc by each method, and by the keys for which it stands."""
    return {name: runs.run(name, DISC, keys) for name, keys in (
        ("silent", {}), ("consistent", {"Method": "consistent"}), ("spelt", CONSISTENT),
        ("paper", {"Method": "paper"}), ("spelt-paper", PAPER))}


def test_it_is_the_word_for_its_keys(discs):
    assert_same_run(discs["silent"], discs["consistent"])
    assert_same_run(discs["silent"], discs["spelt"])
    assert_same_run(discs["paper"], discs["spelt-paper"])
    energies = [discs[name].statistics["mean_energy_density"].iloc[-1]
                for name in ("paper", "consistent")]
    assert energies[0] > 1.03 * energies[1]


def test_parameters_run_again_to_the_same(runs):
    first = runs.run("first", DISC, {"Method": "consistent", PENALTY: "35"})
    keys = parse((first.directory / "parameters.prm").read_text())
    assert (keys["Method"], keys[FORM], normal(keys[PENALTY])) == ("consistent", "bounded", "35")
    assert_same_run(first, runs.run("again", first.directory / "parameters.prm"))


def test_resuming_asks_for_the_values_not_the_word(runs, discs):
    runs.run("halves", DISC, {**CONSISTENT, **HALF})
    halves = runs.run("halves", DISC, {"Method": "consistent"}, "--resume")
    assert without_wall_time(discs["spelt"].directory) == without_wall_time(halves.directory)
    # a scene of before this key goes on as the paper's
    runs.run("older", DISC, {**PAPER, **HALF, "Tissue/Surface": "tracked",
                             "Tissue/Redistribution": "false"})
    error = runs.refused(runs.work / "older.prm", {**DISC, "Method": "consistent"}, "--resume",
                         output=runs.work / "older")
    assert "Nitsche" in error
    assert "as in the snapshot" in error
    runs.run("older", DISC, {"Method": "paper"}, "--resume")


def test_explain_lists_its_keys(runs):
    text = runs.explain(DISC, {"Method": "consistent", PENALTY: "35"})
    assert f"    {PENALTY} = 35 (set by the scene)\n" in text
    assert f"    {FORM} = bounded\n" in text


def test_the_first_line_says_what_differs(runs, discs):
    run = runs.run("but", DISC, {PENALTY: "35", "Material/Energy per": "initial volume", **HALF})
    assert first_line(run) == (f"Method: consistent, but for Material/Energy per = "
                                       f"initial volume, {PENALTY} = 35")
    for name in ("paper", "consistent", "spelt"):
        assert first_line(discs[name]) == "Method: " + name.replace("spelt", "consistent")


@pytest.mark.parametrize("chosen", [
    {}, {"Method": "paper"}, {"Method": "consistent", FORM: "symmetric"}])
def test_tools_complete_a_scene_alike(runs, chosen):
    run = runs.run("keys", DISC, {**chosen, **HALF})
    written = parse((run.directory / "parameters.prm").read_text())
    expected = Program(runs.options.morula).complete(
        {**DISC, **chosen, **HALF, "Output directory": str(run.directory)})
    assert ({key: normal(value) for key, value in written.items()}
            == {key: normal(value) for key, value in expected.items()})
