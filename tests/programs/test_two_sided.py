# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Two-sided obstacles hold what has touched them, and cells behind a wall are told of."""
import pytest

from tests.common.program import assert_same_run

BASE = "Obstacles/base/"
BLOCK = {"Dimension": 2, "Time/End time": 0.6, "Time/Step": 0.1, "Tissue/Shape": "box",
         "Tissue/Size": "80, 60", "Tissue/Cell spacing": 5,
         "Grid/Spacing": 15, "Grid/Offset": "3, 5, 7", "Obstacles/Names": "base",
         BASE + "Shape": "plane", BASE + "Center": "0, -30", BASE + "Normal": "0, 1",
         BASE + "Two-sided": "true", "Output/Formats": "csv", "Output/Interval": 0.1}
PULLED = {**BLOCK, "Body force/Force density": "0; 1e-3*min(t, 0.4)"}
SPACE = {**BLOCK, "Dimension": 3, "Tissue/Size": "80, 60, 60", "Tissue/Cell spacing": 10,
         "Grid/Spacing": 25, BASE + "Center": "0, 0, -30", BASE + "Normal": "0, 0, 1",
         "Body force/Force density": "0; 0; 1e-3*min(t, 0.4)"}
MOULD = {BASE + "Shape": "box", BASE + "Side": "inside", BASE + "Center": "0, 0",
         BASE + "Size": "200, 60"}


def force_of_base(run, axis):
    table = run.forces[run.forces["name"] == "base"]
    return table.iloc[-1][f"force_{axis}"]


@pytest.mark.parametrize("scene, keys, axis, pull", [
    (PULLED, {}, "y", 4e-4 * 80 * 60), (SPACE, {}, "z", 4e-4 * 80 * 60 * 60),
    (PULLED, MOULD, "y", 4e-4 * 80 * 60)])
def test_it_holds_what_pulls(runs, scene, keys, axis, pull):
    """At rest the force is the pull, and the block has moved by h p/(100 E)."""
    run = runs.run("pulled", scene, keys)
    assert abs(force_of_base(run, axis) + pull) <= 1e-6 * pull
    held = run.surface(6)[run.surface(6)["touched"] == 1]
    assert len(held) > 10


def test_it_lets_slide(runs):
    """A force along the plane meets none: the block goes where friction lets it."""
    run = runs.run("slides", BLOCK, {"Body force/Force density": "2e-4; 0",
                                     "Friction/Coefficient": 1e-5})
    assert abs(force_of_base(run, "x")) <= 1e-9
    assert abs(run.cells(6)["x"].mean() - 0.6 * 20) <= 0.1


def test_a_one_sided_one_lets_go(runs):
    run = runs.run("lost", PULLED, {BASE + "Two-sided": "false", "Time/End time": 0.2,
                                    "Body force/Force density": "0; 1e-5",
                                    "Friction/Coefficient": 1e-6})
    assert run.cells(2)["y"].min() > -27.5 + 1
    assert force_of_base(run, "y") == 0


def test_it_is_resumed(runs):
    keys = {"Time/Step": 0.125, "Time/End time": 0.75, "Output/Interval": 0.125,
            "Growth/Law": "rate", "Growth/Rate/Rate": "0.5*(x > 0)", "Death/Rate": "0.3*(y > 0)",
            "Material/Relaxation time": 0.1}
    assert_same_run(runs.run("whole", PULLED, keys),
                    runs.resumed("resumed", PULLED, keys, 0.375))


def test_a_thin_one_is_refused(runs):
    said = runs.refused(PULLED, {BASE + "Shape": "box", BASE + "Center": "0, -35",
                                 BASE + "Size": "200, 10"})
    assert "Obstacles/base/Two-sided" in said and "thick" in said


def test_cells_behind_a_wall(runs):
    """Tissue that is squeezed out between its walls ends the run, with a snapshot."""
    run = runs.run("behind", {
        "Dimension": 2, "Time/End time": 2, "Time/Step": 0.1, "Tissue/Shape": "box",
        "Tissue/Size": "80, 80", "Tissue/Cell spacing": 8, "Grid/Spacing": 24,
        "Tissue/Coarsen surface": "true",
        "Growth/Law": "rate", "Growth/Rate/Rate": 0.7, "Division by size/Volume": 90,
        "Boundary conditions/Fixed where": "Y < -39.9",
        "Boundary conditions/Slip where": "abs(X) > 39.9", "Output/Formats": "csv"}, code=2)
    assert "behind the fixed or slip side with the normal" in run.said
    assert "Two-sided" in run.said
    assert (run.directory / "snapshot.h5").exists()


def test_cells_in_an_obstacle(runs):
    """A thin needle within the tissue, that no boundary point feels: one word."""
    run = runs.run("needle", BLOCK, {
        "Obstacles/Names": "base, needle", "Obstacles/needle/Shape": "box",
        "Obstacles/needle/Size": "12, 12", "Time/Step": 0.05})
    assert run.said.count("in the obstacle 'needle'") == 1
