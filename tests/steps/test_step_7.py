# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Step 7: an added law and an added rule, by closed forms and by the contract."""
import math

import numpy
import pytest
from morula.prm import parse

from tests.common.program import assert_same_columns, assert_same_file
from tests.common.results import read_csv
from tests.steps.conftest import PRM

RULE = "Proliferation/Cell cycle/Division axis"
LAW = "Growth/Crowding limited/"
MEMORY = "Proliferation/Cell cycle/Long axis/Memory"

# A rigid box: all of its surface is held, and all cells grow alike. So F = I.
BOX = {"Tissue/Size": "100, 100", "Material/Volumetric strain": "pointwise",
       "Boundary conditions/Nitsche form": "symmetric",
       "Boundary conditions/Nitsche penalty": "1e3",
       "Boundary conditions/Fixed where": "1",
       "Boundary conditions/Displacement": "0; 0; 0", "Proliferation/Law": "none",
       RULE: "random", LAW + "Rate": "0.5", "Output/Formats": "none"}
SHORT = {"Tissue/Cell spacing": "20", "Grid/Spacing": "50", "Time/End time": "1",
         "Time/Step": "0.1", "Output/Interval": "0", "Output/Formats": "csv"}


def test_rigid_box(step):
    """J = 1/det F_g, the same in all cells, obeys dJ/dt = -(2 k/c) J (J - (1-c)), a
    logistic equation; the law is first order in the time step."""
    def elastic_volume(dt, time):
        step({**BOX, "Time/Step": dt, "Time/End time": time})
        row = read_csv(step.output / "statistics.csv")[-1]
        assert row["time"] == time
        assert abs(row["min_elastic_volume_ratio"]
                   - row["max_elastic_volume_ratio"]) <= 1e-8
        return row["min_elastic_volume_ratio"]

    a, k, t = 0.8, 0.5, 0.2
    exact = a / (1 - (1 - a) * math.exp(-2 * k * a / (1 - a) * t))
    errors = [abs(elastic_volume(dt, t) - exact) for dt in (0.05, 0.025, 0.0125)]
    assert errors[-1] < 0.0025
    for coarse, fine in zip(errors, errors[1:]):
        assert abs(coarse / fine - 2) <= 0.2
    # It comes to rest at 1 - c.
    assert abs(elastic_volume(0.1, 2) - a) <= 1e-4


@pytest.mark.parametrize("rule, memory, along", [
    ("long axis", None, True), ("random", None, False), ("long axis", 0.05, True),
    ("long axis", 1000, False)])
def test_division_rule(step, rule, memory, along):
    """The strip is pulled along x: so are its cells, and their daughters lie side by
    side; by random axes the mean of |cos| is 2/pi. Who forgets within a step of a tenth
    of a day divides along the pull; who remembers 1000 days, in which nothing was
    stretched, does not know of it."""
    step({**SHORT, RULE: rule, **({MEMORY: memory} if memory else {})})
    lineage = read_csv(step.output / "lineage.csv")
    born = lineage[lineage["parent"] >= 0]
    first, second = born[0::2], born[1::2]
    # Cells that entered S before the pull could be felt take any axis.
    late = first["birth_time"] > 0.75
    first, second = first[late], second[late]
    assert len(first) > 30
    assert (first["parent"] == second["parent"]).all()
    x = first["x"] - second["x"]
    mean = (abs(x) / numpy.hypot(x, first["y"] - second["y"])).mean()
    assert mean > 0.95 if along else abs(mean - 2 / math.pi) <= 0.1


def test_resume(step):
    whole, resumed = step.output / "whole", step.output / "resumed"
    scene = {**SHORT, MEMORY: "0.2"}
    step(scene, output=whole)
    step({**scene, "Time/End time": "0.5"}, output=resumed)
    assert LAW + "Rate" in step({**scene, LAW + "Rate": "0.06"}, "--resume",
                                output=resumed, code=1)
    step(scene, "--resume", output=resumed)
    assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")
    assert_same_columns(*(sorted(path.glob("cells-*.csv"))[-1]
                          for path in (whole, resumed)))
    keys = parse((whole / "parameters.prm").read_text())
    assert keys["Growth/Law"] == "crowding limited" and MEMORY in keys


@pytest.mark.parametrize("key, value", [
    (LAW + "Crowding", "0"), (LAW + "Rate", "1 +"),
    *(pytest.param(*words, marks=pytest.mark.release) for words in (
        (LAW + "Crowding", "1"), ("Growth/Law", "crowding"),
        (RULE[:-13] + "Long axis/Least elongation", "0.5"))),
    # Its expressions are asked before any work: Z is unknown in 2-D.
    (LAW + "Rate", "0.1 + Z")])
def test_refusals(step, key, value):
    assert key in step({key: value}, code=1)
    assert not step.output.exists()


def test_contract(step, runs):
    keys = runs.call([runs.options.morula, "--parameters"]).stdout
    for line in ("subsection Crowding limited", "set Crowding = 0.2",
                 "subsection Long axis", "set Least elongation = 1.02"):
        assert line in keys
    text = step({}, "--explain")
    assert "crowding limited" in text and "long axis" in text


def test_forgotten(step, runs):
    """Values of an effect that nothing switches on."""
    scene = runs.write("forgotten.prm", "subsection Growth\nsubsection Crowding limited\n"
                       "set Rate = 2\nend\nend\n")
    assert "Growth/Law = crowding limited" in step(prm=scene, code=1)


def test_morula_does_not_know(runs):
    morula = runs.options.morula.with_name("morula")
    assert "crowding limited" in runs.call([morula, PRM / "step-7.prm"], 1).stderr
