# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells with types: tables that agree, what a transition does to the stress, and what
a rate that becomes wrong in mid-run does."""
import math

import pytest
from scipy.optimize import fsolve

from tests.common.program import SCENES

SCENE = SCENES / "cell-types.prm"
RATE = "Cell types/transit/Transitions/To resting"
# A slab in plane strain that is stretched by a tenth in a frame of the same shape,
# becomes three times as stiff in the third step, and is stretched further.
STIFFENING = {"Dimension": 2, "Method": "paper", "Time/End time": 0.4, "Time/Step": 0.1,
              "Tissue/Shape": "box", "Tissue/Size": "80, 40", "Tissue/Cell spacing": 5,
              "Grid/Spacing": 20, "Material/Energy per": "grown volume",
              "Cell types/Names": "soft, hard",
              "Cell types/soft/Transitions/To hard": "1e4*(t > 0.22)",
              "Cell types/hard/Material/Young's modulus": 3,
              "Boundary conditions/Fixed where": 1,
              "Boundary conditions/Displacement":
                  "(0.1*min(t/0.1, 1) + 0.05*(t > 0.35))*X; 0",
              "Solver/Newton tolerance": 1e-8, "Output/Formats": "csv", "Output/Interval": 0.1}


def test_numbers_add_up(runs):
    run = runs.run("types", SCENE, {RATE: "0.8 + 0.2*hill(age, 1, 2)", "Time/End time": 1.5})
    names = ["transit", "stem", "resting"]
    born, events = run.lineage.table, run.events
    kinds = {cell: names[int(kind)] for cell, kind in zip(born["id"], born["type"])}
    assert len(events) > 20
    assert {*events["event"]} == {"transition"}
    for _, event in events.iterrows():
        assert kinds[event["id"]] == event["from"]
        kinds[event["id"]] = event["to"]
    living = [kinds[cell] for cell in run.lineage.living]
    last = run.statistics.iloc[-1]
    assert [living.count(name) for name in names] == [last["cells_" + name] for name in names]
    assert len(living) == last["cells"]


def stress(stretch, E):
    """In the direction of the stretch, kPa; nu = 0.4."""
    return cauchy((stretch, 1), E)[0]


def cauchy(stretches, E):
    """Both principal stresses in the plane, kPa; nu = 0.4."""
    J = math.prod(stretches)
    return [E / J * ((stretch**2 - 1) / 2.8 + 0.4 / 1.4 / 0.2 * math.log(J))
            for stretch in stretches]


def same_stress(stretches, E, later_E):
    """The principal stretches with the same stresses at another stiffness."""
    wanted = cauchy(stretches, E)
    return fsolve(lambda x: [a - b for a, b in zip(cauchy(x, later_E), wanted)], [1, 1],
                  xtol=1e-12)


KEPT = same_stress((1.1, 1), 1, 3)


@pytest.mark.parametrize("choice, after, later", [
    ("keep strain", stress(1.1, 3), stress(1.15, 3)),
    ("keep stress", stress(1.1, 1), cauchy((KEPT[0] * 1.15 / 1.1, KEPT[1]), 3)[0]),
    ("forget stress", 0, stress(1.15 / 1.1, 3))])
def test_stress_at_a_transition(runs, choice, after, later):
    """A cell keeps its strain, so that its stress grows with the stiffness; or its
    stress; or it forgets that: then only what comes afterwards stretches it."""
    run = runs.run("slab", STIFFENING, {"Material/On transition": choice})
    for number, exact in ((1, stress(1.1, 1)), (3, after), (4, later)):
        assert abs(run.cells(number)["sigma_xx"].mean() - exact) < 1e-3 * stress(1.1, 1)


@pytest.mark.parametrize("key, value, allowed", [
    (RATE, "0.5 - t", ">= 0"),
    ("Friction/Coefficient", "1e-6*volume*sqrt(0.3-t)", "allowed is a finite value")])
def test_wrong_in_mid_run(runs, key, value, allowed):
    run = runs.run(key.split("/")[0], SCENE, {key: value}, "--replace", code=2)
    for part in (f"{key} = '{value}'", allowed, "snapshot.h5"):
        assert part in run.said
    assert (run.directory / "snapshot.h5").exists()


def test_absent(runs):
    run = runs.run("absent", SCENES / "proliferating-disc.prm", {"Time/End time": 0.1})
    assert not (run.directory / "events.csv").exists()
    assert "type" not in run.lineage.table
    assert not [name for name in run.statistics if name.startswith("cells_")]
