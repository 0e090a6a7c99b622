# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the program says before and in a run that a user may not have meant:
pieces that nothing holds, and keys that do nothing."""
import math

import h5py
import numpy as np
import pytest

BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Time/End time": 0.2,
       "Time/Step": 0.1, "Output/Formats": "none"}
POINTS = {"Dimension": 2, "Tissue/Shape": "points", "Grid/Spacing": 20, "Time/End time": 0.2,
          "Time/Step": 0.1, "Output/Formats": "none"}
FIXED, SLIP = "Boundary conditions/Fixed where", "Boundary conditions/Slip where"
TRACTION, WEIGHT = "Boundary conditions/Traction", "Body force/Force density"
HELD = {**BOX, FIXED: "X < -49.9"}
PULLED = {**HELD, TRACTION + " where": "X > 49.9"}
PULL = {**PULLED, TRACTION: "0.01*t; 0"}
TYPES = {**BOX, "Cell types/Names": "a, b"}
RATE = {**BOX, "Growth/Law": "rate"}
LEAVES = {**BOX, "Death/Shrinking time": 0}
# A box of 80 um, of 12 triangles.
CUBE = ("OFF|8 12 0|0 0 0|80 0 0|80 80 0|0 80 0|0 0 80|80 0 80|80 80 80|0 80 80|3 0 2 1|3 0 3 2"
        "|3 4 5 6|3 4 6 7|3 0 1 5|3 0 5 4|3 1 2 6|3 1 6 5|3 2 3 7|3 2 7 6|3 3 0 4|3 3 4 7")


def field(**keys):
    return {**BOX, "Fields/Names": "u", **{f"Fields/u/{key.replace('_', ' ')}": value
                                           for key, value in keys.items()}}


def obstacle(shape, **keys):
    return {**BOX, "Obstacles/Names": "o", "Obstacles/o/Shape": shape,
            **{f"Obstacles/o/{key}": value for key, value in keys.items()}}


def columns_of(group):
    """The places of a snapshot's columns in the rows of its points."""
    places, first = {}, 0
    for line in group["columns"][()][0].decode().splitlines():
        name, n = line.split()
        places[name] = range(first, first + int(n))
        first += int(n)
    return places


def amounts(run, *fields):
    """Amounts of fields in all cells of a 2-D run's snapshot, and the cells'
    volume: tables have too few digits."""
    with h5py.File(run.directory / "snapshot.h5") as file:
        rows = file["cells/properties"][()].T
        at = columns_of(file["cells"])
    F = rows[at["deformation"]].T.reshape(-1, 2, 2)
    volume = rows[at["initial_volume"]][0] * np.linalg.det(F)
    return *((volume * rows[at[name]][0]).sum() for name in fields), volume.sum()


def points(runs, places):
    rows = [",".join(f"{x:.12g}" for x in row) for row in places]
    return {"Tissue/Points file": runs.write("cells.csv", "\n".join(["x,y,volume", *rows]))}


@pytest.mark.parametrize("ranks", [1, 2])
def test_pieces(runs, ranks):
    """Of two bodies one is held; the other one is pulled and flies."""
    rows = [(x, y, 25) for y in np.arange(-22.5, 25, 5)
            for x in (*np.arange(-97.5, -20, 5), *np.arange(42.5, 90, 5))]
    keys = {**POINTS, **points(runs, rows), FIXED: "X < -97", TRACTION + " where": "X > 87",
            TRACTION: "0.02*t; 0"}
    held = "160 cells around (-60 0) um, supported at 14 boundary points"
    free = "100 cells around (65 0) um, not supported; loads add up to a force of (0."
    run = runs.run("pieces", keys, ranks=ranks)
    for text in (run.said, (run.directory / "log.txt").read_text()):
        assert "Connected tissue: " + held + "\n" in text
        assert "Connected tissue: " + free in text
    assert "nothing fixes the part of 100 cells" in run.said
    explained = runs.explain(keys)
    assert held in explained
    assert free in explained
    said = runs.run("rubbed", keys, {"Friction/Coefficient": 0.01}).said
    assert "100 cells around (65 0) um, supported by friction\n" in said
    assert "nothing fixes" not in said


@pytest.mark.parametrize("keys, load", [
    ({WEIGHT: "0; -1e-5"}, "a force of (0 -0.1) kPa um and a moment of 0 kPa um^2"),
    # Σ V (x² + y²) c over the lattice's points
    ({WEIGHT: "-1e-6*Y; 1e-6*X"}, "a force of (0 0) kPa um and a moment of 16.5 kPa um^2"),
    ({SLIP: "Y < -49.9", TRACTION + " where": "X > 49.9", TRACTION: "0.01; 0"},
     "a force of (1 0) kPa um and a moment of 0 kPa um^2"),
    ({SLIP: "Y < -49.9", WEIGHT: "0; -1e-5"}, None),
    ({"Boundary conditions/Pressure where": 1, "Boundary conditions/Pressure": 0.01}, None)])
def test_what_inertia_balances(runs, keys, load):
    """Weight, a moment, and a slip plane that does not hold what slides."""
    said = runs.run("inertia", BOX, keys).said
    assert ("inertia balances" in said) == (load is not None)
    assert load is None or load in said


@pytest.mark.parametrize("weight, drifts", [("1e-6", True), ("-1e-6", False)])
def test_drift_against_an_obstacle(runs, weight, drifts):
    plane = obstacle("plane", Center="0, -50, 0", Normal="0, 1, 0")
    said = runs.run("drift", plane, {WEIGHT: f"0; {weight}"}).said
    assert ("drifts until an obstacle stops it" in said) == drifts


def test_closed_gap(runs):
    """A cavity of 6 x 6 cells of 10 um has a surface of its own."""
    rows = [(x, y, 100) for x in np.arange(-95, 100, 10) for y in np.arange(-95, 100, 10)
            if max(abs(x), abs(y)) > 25]
    keys = {**POINTS, **points(runs, rows), "Grid/Spacing": 40, "Time/End time": 0.1,
            "Tissue/Points surface": "always", "Output/Formats": "csv"}
    run = runs.run("narrow", keys)
    assert "the surface around the cells has filled cavities" not in run.said
    assert len(run.surface(0).query("abs(x) < 60 and abs(y) < 60")) > 10
    assert "allowed is 2" in runs.refused(keys, {"Tissue/Closed gap": 3})


@pytest.mark.parametrize("faces", [(), (10,), (10, 15, 20), range(10, 22)])
def test_faces_turned_round(runs, faces):
    lines = [" ".join([line.split()[0], *line.split()[:0:-1]]) if i in faces else line
             for i, line in enumerate(CUBE.split("|"))]
    run = runs.run("turned", {
        "Tissue/Shape": "mesh", "Tissue/Cell spacing": 10, "Grid/Spacing": 40,
        "Tissue/Surface mesh": runs.write("cube.off", "\n".join(lines) + "\n"),
        "Time/End time": 0.1, "Time/Step": 0.1, "Output/Formats": "none"})
    assert abs(run.statistics["total_volume"][0] - 80**3) <= 5e-8


@pytest.mark.parametrize("scale", [1e-6, 1e-3])
def test_points_in_metres(runs, scale):
    rows = [(x * scale, y * scale, 100 * scale**2) for x in np.arange(-45, 50, 10)
            for y in np.arange(-45, 50, 10)]
    keys = {**POINTS, **points(runs, rows), "Grid/Spacing": 40, "Time/End time": 0.1}
    assert "such as m, mm or nm?" in runs.run("metres", keys).said


NOWHERE = "it acts nowhere: at all 10"
ALONE = "it does nothing without "


@pytest.mark.parametrize("keys, word", [
    ({**PULLED, TRACTION + " where": "X < -49.9", TRACTION: "0.1; 0"}, NOWHERE),
    ({**BOX, TRACTION + " where": "X > 49.9", TRACTION: "0.1; 0", SLIP: 1}, NOWHERE),
    ({**BOX, "Material/Yield stress": 1}, ALONE),
    ({**RATE, "Growth/Rate/Homeostatic stress": -1}, ALONE),
    ({**RATE, "Growth/Rate/Rate": 0.1, "Growth/Rate/Share along": 0.5}, ALONE),
    ({**BOX, "Boundary conditions/Surface tension where": "X > 0"}, ALONE),
    ({**BOX, "Contact/Friction": 0.1}, ALONE),
    ({**BOX, "Boundary conditions/Nitsche penalty": 50}, ALONE),
    (field(Diffusion=1e4, Consumption=1, Value=1, Fixed_where="X + Y > 90"), "by a whole patch"),
    (field(Diffusion=100, Consumption=1e4, Value=1, Fixed_where=1),
     "the field reaches only 0.1 um"),
    ({**BOX, "Growth/Law": "isotropic", "Growth/Isotropic/Stretch": 1.5},
     "by a factor of up to 1.5"),
    ({**BOX, "Tissue/Cell spacing": 7, "Tissue/Surface cells": "whole"}, "the lattice does not fit the shape")])
def test_words(runs, keys, word):
    assert word in runs.run("words", keys).said


@pytest.mark.parametrize("keys", [HELD, PULL])
def test_no_words(runs, keys):
    assert "Warning" not in runs.run("plain", keys).said


@pytest.mark.parametrize("production, mean", [("t > 0.15", 0.1), ("2*t", 0.06)])
def test_expressions_of_transient_fields(runs, production, mean):
    """A source that begins in mid-run acts in the step that ends there, and
    one that rises has the error of Euler's implicit method."""
    run = runs.run("source", field(Time="transient", Diffusion=100, Production=production))
    assert abs(run.statistics["u_mean"].iloc[-1] - mean) <= 5e-8


@pytest.mark.parametrize("keys", [
    field(Diffusion=100, Production="5*u", Consumption=1, Fixed_where=1, Value=1),
    {**BOX, "Fields/Names": "a, b", "Fields/a/Diffusion": 100, "Fields/b/Diffusion": 100,
     "Fields/a/Production": "3*b", "Fields/a/Value": 1, "Fields/b/Production": "3*a",
     "Fields/a/Consumption": 1, "Fields/b/Consumption": 1, "Fields/a/Fixed where": 1}])
def test_fields_without_a_state(runs, keys):
    assert "has no steady state" in runs.refused(keys, {}, "--replace")


@pytest.mark.parametrize("diffusion", [100, 1e5])
def test_amounts_of_fields_that_read_each_other(runs, diffusion):
    both = {f"Fields/{name}/{key}": value for name in "ab" for key, value in (
        ("Time", "transient"), ("Diffusion", diffusion), ("Initial", "2*(X > 0)"))}
    run = runs.run("both", BOX, {
        "Fields/Names": "a, b", "Time/End time": 1, **both, "Fields/a/Consumption": 3,
        "Fields/a/Production": "b", "Fields/b/Consumption": 1, "Fields/b/Production": "3*a"})
    a, b, volume = amounts(run, "a", "b")
    assert abs((a + b) / (2 * volume) - 1) <= 1e-11
    assert a / volume < 0.6


def test_amounts_at_removal(runs):
    """Cells that go leave the field that they carry, to rounding."""
    run = runs.run("gone", field(Time="transient", Diffusion=10, Initial=1), {
        "Tissue/Size": "96, 96", "Tissue/Cell spacing": 8, "Grid/Spacing": 32,
        "Time/End time": 0.5,
        "Material/Relaxation time": 0.05,
        "Death/When": "noise < 0.5", "Death/Shrinking time": 0.3,
        "Death/Final volume": 0.05}, ranks=2)
    amount, _ = amounts(run, "u")
    assert run.statistics["cells"].iloc[-1] < 90
    assert abs(amount / 96**2 - 1) <= 1e-10


def test_separate_pieces_of_a_field(runs):
    """A value at one of two bodies: nothing tells the level in the other."""
    rows = [(x, y, 100) for y in np.arange(-25, 30, 10)
            for x in (*np.arange(-95, -40, 10), *np.arange(45, 100, 10))]
    keys = {**POINTS, **points(runs, rows), "Time/End time": 0.1, "Grid/Spacing": 30,
            "Fields/Names": "u", "Fields/u/Diffusion": 1000, "Fields/u/Fixed where": "X < 0",
            "Fields/u/Value": 1}
    word = "has neither source nor sink of the steady field 'u'"
    assert word in runs.run("parts", keys).said
    assert word not in runs.run("parts", keys, {"Fields/u/Consumption": 1}).said
    assert ("of each separate part of the tissue"
            in runs.refused(keys, {"Fields/u/Production": 1}, "--replace"))


def test_an_obstacle_in_the_tissue(runs):
    assert "4 cells lie in it" in runs.run("ball", obstacle("sphere", Radius=10)).said


def test_a_plate_that_must_not_pass(runs):
    """A plate of 8 um comes 10 um in each step."""
    plate = obstacle("box", Size="200, 8, 8", Center="0, -60, 0", Velocity="0; 100; 0")
    run = runs.run("plate", plate, {FIXED: "Y > 49.9", "Output/Formats": "csv"})
    assert run.surface(1)["y"].min() > -37


@pytest.mark.parametrize("E", ["2", "if(X > 0, 1, 2)*(1 + 0*age)"])
def test_a_fold_against_friction(runs, E):
    """12 zeta/(E H^2) (lambda/2 pi)^4 with H = 80 um, lambda = 10 H."""
    text = runs.explain(BOX, {"Friction/Coefficient": 1e-5, "Material/Young's modulus": E})
    time = 12e-5 / (2 * 80**2) * (800 / (2 * math.pi))**4
    assert f"fold in {time:.6g} day at a wavelength of 800 um" in text
