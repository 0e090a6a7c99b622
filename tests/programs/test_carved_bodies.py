# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that die at t = 0 in a scene with contact: the tissue is carved before its first
step, and the surface of each body that they leave is closed again."""
import pytest

CARVED = {"Dimension": 2, "Time/End time": 0.2, "Time/Step": 0.1, "Output/Formats": "csv",
          "Tissue/Radius": 60, "Tissue/Cell spacing": 10, "Grid/Spacing": 20,
          "Death/Shrinking time": 0, "Contact/Between": "bodies"}
BY_TYPE = {"Cell types/Names": "a, b", "Cell types/b/Where": "X > 0",
           "Contact/Bodies": "cell type", "Death/When": "X > 10"}
DISCS = "\n".join(["x,y", *(f"{x + side * 45},{y}" for side in (-1, 1)
                           for x in range(-35, 40, 5) for y in range(-35, 40, 5)
                           if x * x + y * y < 1250)])


@pytest.mark.parametrize("name, ranks", [
    ("by type", 1), pytest.param("by type", 2, marks=pytest.mark.release),
    ("apart", 1), ("apart", 2)])
def test_surface(runs, name, ranks):
    keys = dict(CARVED)
    if name == "by type":
        keys |= BY_TYPE
    else:
        keys |= {"Tissue/Shape": "points", "Tissue/Cell spacing": 5, "Grid/Spacing": 10,
                 "Tissue/Points file": runs.write("discs.csv", DISCS + "\n"),
                 "Death/When": "X > 60"}
    rows = runs.run(f"{name.split()[-1]}-{ranks}", keys, ranks=ranks).statistics
    enclosed, volume = rows["enclosed_volume"], rows["total_volume"]
    assert enclosed.tolist() == pytest.approx(volume.tolist(), rel=0.01)
    assert rows["removed"].iloc[0] > 20
    assert rows["removed"].iloc[1:].sum() == 0


def test_the_rim_of_a_held_side(runs):
    """A box that is cut to a rod on a sheet between two walls: what is left of patches at
    the rim has its place in `Slip where`, but is held by no wall."""
    run = runs.run("rod", {
        "Dimension": 3, "Time/End time": 0.1, "Time/Step": 0.1, "Output/Formats": "csv",
        "Tissue/Shape": "box", "Tissue/Size": "60, 70, 30", "Tissue/Center": "0, -20, 0",
        "Tissue/Cell spacing": 5, "Grid/Spacing": 15, "Grid/Offset": "0, 0, 7.5",
        "Death/Shrinking time": 0,
        "Death/When": "Y^2 + Z^2 > 15.5^2 && (Y > 0 || abs(Z) > 5)",
        "Boundary conditions/Fixed where": "Y < -54.9",
        "Boundary conditions/Slip where": "abs(X) > 29.9"})
    surface = run.surface(0)
    slip = surface["condition"] == 2
    assert slip.sum() > 100
    assert (abs(surface["nx"][slip]) > 0.99).all()


@pytest.mark.parametrize("ranks", [1, 2])
def test_what_is_left_apart_is_two_bodies(runs, ranks):
    """A bar whose middle is carved away: its ends are pushed together, and press."""
    keys = {**CARVED, "Tissue/Shape": "box", "Tissue/Size": "200, 60", "Tissue/Cell spacing": 5,
            "Grid/Spacing": 15, "Death/When": "abs(X) < 10", "Time/End time": 1,
            "Boundary conditions/Fixed where": "abs(X) > 99",
            "Boundary conditions/Displacement": "15*t*(1 - 2*(X > 0)); 0"}
    run = runs.run(f"parted-{ranks}", keys, ranks=ranks)
    cells = run.cells(0)
    assert {*cells[cells["x"] < 0]["body"]} == {0} and {*cells[cells["x"] > 0]["body"]} == {1}
    pressed = run.cells(len(run.times) - 1)
    assert pressed[pressed["x"] > 0]["x"].min() > 0 > pressed[pressed["x"] < 0]["x"].max()
    assert pressed["sigma_xx"].mean() < -0.02
