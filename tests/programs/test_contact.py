# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies in contact against closed forms: they press, slide, part again, and no
step lets them pass through each other."""

import numpy as np
import pytest

from tests.common.bodies import (annulus, block, blocks, circle, contact_rows, points_scene, press,
                                 rectangle)
from tests.common.program import POINTWISE, WHOLE, assert_same_run

ONE_STEP = {"Time/End time": 1, "Time/Step": 1, "Output/Interval": 1}
GROWTH, SHARE = "Growth/Rate/Rate", "0.2/(1 + 0.1*t)"
RING = {**POINTWISE, "Tissue/Boundary points": 300, "Time/End time": 2,
        "Time/Step": 0.5, "Output/Interval": 1, "Growth/Law": "rate"}


@pytest.mark.parametrize("ranks, offset, E, exact, within", [
    (1, "0, 0", "1", 0.1542733, 1e-3), (3, "3.7, 6.1", "1", 0.1542733, 1e-3),
    (1, "8.9, 8.9", "1", 0.1542733, 1e-3), (1, "1.3, 5", "if(type == b, 10, 1)", 0.2978, 2e-3)])
def test_blocks_press_as_one(runs, ranks, offset, E, exact, within):
    """Uniaxial strain of two blocks, also of unequal ones, wherever the grid
    lies and on any ranks: pressure and evenness."""
    run = runs.run("pressed", blocks(runs, 1e-4), {
        **press(60, "10*t"), "Grid/Offset": offset, "Material/Young's modulus": E}, ranks=ranks)
    last = contact_rows(run).iloc[-1]
    assert last["name"] == "body 0 on body 1"
    assert abs(last["force_y"] / 60 / exact - 1) <= within
    if E == "1":
        stress = run.cells(4)["sigma_yy"]
        assert np.std(stress) < 8e-3 * abs(np.mean(stress))
        points = run.surface(4)
        middle = ((abs(points["ny"]) > 0.9) & (abs(points["Y"] - 30) < 1)
                  & (abs(points["x"] - 30) < 20))
        assert abs(points["contact_pressure"][middle] / exact - 1).max() < 0.03


def ring(runs):
    """A disc in a ring."""
    return points_scene(runs, annulus(0, 20, "a") + annulus(20, 40, "b"),
                        [[circle(20)], [circle(40), circle(20.001, sign=-1)]])


@pytest.mark.parametrize("offset, E, exact, within", [
    ("0, 0", 1, (0.0391286, 0.06945), 5e-3), ("7.4, 9.2", 1, (0.0391286,), 5e-3),
    ("0.3, 4.7", 1, (0.0391286,), 5e-3), ("9, 1.1", 0.2, (0.0087181,), 1e-2)])
def test_core_that_grows_in_a_ring(runs, offset, E, exact, within):
    """The radial equations with the penalty; anywhere on the grid, also in a softer
    ring."""
    run = runs.run("core", ring(runs), {
        **RING, GROWTH: f"(type == a)*{SHARE}", "Grid/Offset": offset,
        "Time/End time": len(exact), "Material/Young's modulus": f"if(type == b, {E}, 1)"})
    rows = contact_rows(run)
    np.testing.assert_allclose(rows["force_inward"] / rows["area"], exact, rtol=within)
    if len(exact) == 2:
        assert run.statistics["newton_iterations"].max() <= 12
        assert (np.hypot(rows["force_x"], rows["force_y"]) < 1e-3 * rows["force_inward"]).all()
        grown = run.statistics["xmax"].iloc[-1] - run.statistics["xmax"][0]
        assert abs(grown - 2.004) <= 0.01


def test_resumed_where_steps_are_not_exact(runs):
    """3 * 0.1 is not 0.3: a run to 0.3 ends where a longer one goes on, to the
    bit, in contact and with relaxation."""
    keys = {**RING, GROWTH: f"(type == a)*{SHARE}", "Material/Relaxation time": 0.3,
            "Time/End time": 0.5, "Time/Step": 0.1,
            "Output/Interval": 0.3}
    assert_same_run(runs.run("inexact", ring(runs), keys),
                    runs.resumed("inexact-parts", ring(runs), keys, 0.3))


def test_ring_that_grows_off_its_core(runs):
    run = runs.run("off", ring(runs), {**RING, GROWTH: f"(type == b)*{SHARE}"})
    assert len(contact_rows(run)) == 0
    points = run.surface(2)
    points = points[(points["body"] == 1) & (np.hypot(points["x"], points["y"]) < 30)]
    ratio = np.hypot(points["x"], points["y"]) / np.hypot(points["X"], points["Y"])
    assert abs(ratio - 1.2).max() < 1e-3
    core = run.cells(2).query("body == 0")
    assert np.hypot(core["x"] - core["X"], core["y"] - core["Y"]).max() < 1e-4
    assert abs(core[["sigma_xx", "sigma_yy", "sigma_xy"]]).max().max() < 1e-8


@pytest.mark.parametrize("offset", ["0, 0", "3, 7"])
def test_two_discs_are_one_at_a_mirror(runs, offset):
    """Two discs between clamps press as one against a plane: exact by
    symmetry."""
    keys = {"Time/End time": 1, "Output/Interval": 1, "Grid/Offset": offset}
    scene = points_scene(runs, annulus(0, 40, "a", 40.02) + annulus(0, 40, "b", -40.02),
                         [[circle(40, 40.02)], [circle(40, -40.02)]])
    two = runs.run("two", scene, {
        **keys, "Tissue/Boundary points": 250, "Boundary conditions/Fixed where": "abs(Y) > 77",
        "Boundary conditions/Displacement": "0; if(Y > 0, -8*t, 0)"})
    one = runs.run("one", points_scene(runs, annulus(0, 40, "a", 40.02), [[circle(40, 40.02)]]), {
        **keys, "Tissue/Boundary points": 125, "Contact/Between": "none",
        "Obstacles/Names": "floor", "Obstacles/floor/Shape": "plane",
        "Obstacles/floor/Normal": "0; 1", "Boundary conditions/Fixed where": "Y > 77",
        "Boundary conditions/Displacement": "0; -4*t"}).forces
    wall = one[one["kind"] == "obstacle"].iloc[-1]["force_y"]
    assert abs(-contact_rows(two).iloc[-1]["force_y"] / wall - 1) <= 0.01


@pytest.mark.parametrize("gap, way, least", [
    (10, 20, 20), (25, 30, 5)])  # too far apart to be looked at at first
def test_no_step_is_too_long(runs, gap, way, least):
    """A lid that comes down by two grid spacings in one step stops at the
    block below."""
    run = runs.run("lid", blocks(runs, gap), {**press(60 + gap, f"{way}*t"), **ONE_STEP})
    assert run.statistics["rejected_steps"].sum() > 0
    assert contact_rows(run).iloc[-1]["force_y"] > least
    cells = run.cells(1)
    assert cells["y"][cells["body"] == 1].min() > cells["y"][cells["body"] == 0].max()


def test_a_lid_that_is_drawn_back_leaves_no_force(runs):
    run = runs.run("back", blocks(runs, 10), {
        **press(70, "60*(t - t*t)"), "Time/End time": 1, "Time/Step": 0.05,
        "Output/Interval": 0.25})
    force, time = (contact_rows(run)[name] for name in ("force_y", "time"))
    assert abs(force.iloc[0] / force.iloc[-1] - 1) <= 2e-3
    assert time.iloc[-1] == 0.75
    assert (abs(run.cells(4)["sigma_yy"]).max() < 1e-3 * abs(run.cells(2)["sigma_yy"]).max())


def test_viscous_friction(runs):
    """Blocks that slide at a velocity v resist with the friction times v."""
    run = runs.run("slide", blocks(runs, 1e-4), {
        "Boundary conditions/Fixed where": "Y < 0.001 || Y > 59.999",
        "Boundary conditions/Displacement":
            "if(Y > 30, 2*t, 0); if(Y > 30, -0.2*min(t/0.2, 1), 0)",
        **WHOLE, "Tissue/Boundary points": 144, "Contact/Friction": 0.01,
        "Material/Young's modulus": 20,
        "Time/End time": 1, "Output/Interval": 0.5})
    assert abs(contact_rows(run).iloc[-1]["force_x"] / (-0.01 * 2 * 58) - 1) <= 0.03


def test_discs_fuse(runs):
    """Two discs that have touched for some time become one body with one
    closed surface, whose tension draws it together; on any ranks, and
    resumed bit for bit."""
    cells = annulus(0, 20, "a", -22) + annulus(0, 20, "b", 22)
    scene = points_scene(runs, [(y, x, v, t) for x, y, v, t in cells],
                         [[[(y, x) for x, y in reversed(circle(20, center))]]
                          for center in (-22, 22)])
    keys = {"Contact/Bodies": "apart", "Contact/Fusion time": 0.2, "Contact/Friction": 0.01,
            "Tissue/Coarsen surface": "true",
            "Growth/Law": "rate", GROWTH: "0.6*(t < 0.6)", "Material/Relaxation time": 0.1,
            "Boundary conditions/Surface tension": 0.5, "Friction/Coefficient": 1e-6,
            "Time/End time": 2, "Output/Interval": 0.4}
    run = runs.run("fuse", scene, keys)
    assert set(run.surface(1)["body"]) == {0, 1}
    surface, rows = run.surface(5), run.statistics
    assert set(surface["body"]) == {0}
    for i in ("x", "y"):
        assert abs((surface["area"] * surface[f"n{i}"]).sum()) < 1e-3 * surface["area"].sum()
    width = rows["xmax"] - rows["xmin"]
    assert width.iloc[-1] < 0.97 * width.max()
    assert abs(rows["total_volume"].iloc[-1] / rows["grown_volume"].iloc[-1] - 1) <= 0.02
    assert_same_run(run, runs.resumed("parts", scene, keys, 0.8))
    again = runs.run("two", scene, keys, ranks=2).statistics
    assert abs(rows["xmax"].iloc[-1] - again["xmax"].iloc[-1]) <= 1e-3


def test_a_body_that_dies(runs):
    """leaves no surface behind; a type without cells is no body."""
    scene = blocks(runs, 1e-4)
    surface = runs.run("dies", scene, {
        "Tissue/Boundary points": 144, "Cell types/Names": "a, b, c",
        "Death/When": "t > 0.15 && type == b", "Death/Shrinking time": 0}).surface(4)
    assert (len(surface), set(surface["body"])) == (72, {0})
    surface = runs.run("empty", scene, {
        "Tissue/Points surface": "automatic", "Cell types/Names": "a, c, b",
        "Time/End time": 0.1}).surface(1)
    assert set(surface["body"]) == {0, 2}


def test_fields_that_end_at_each_body(runs):
    """A steady and a transient field in bodies that touch, on ranks."""
    scene = {**blocks(runs, 1e-4), **press(60, "5*t"), "Fields/Names": "o, m",
             "Fields/o/Diffusion": 1000, "Fields/o/Consumption": 1,
             "Fields/o/Fixed where": "Y < 0.001 || Y > 59.999", "Fields/o/Value": 1,
             "Fields/m/Diffusion": 100, "Fields/m/Time": "transient", "Fields/m/Initial": 1,
             "Fields/m/Consumption": 1}
    one, two, together = (
        runs.run("ends", scene, {"Contact/Fields pass": passes}, ranks=ranks)
        .statistics["o_min"].iloc[-1]
        for passes, ranks in (("false", 1), ("false", 2), ("true", 1)))
    assert abs(one - two) <= 1e-6
    assert abs(one - together) <= 0.01


def test_touching_faces_are_no_surface_for_fields(runs):
    """A field that is held at all of the surface: two blocks that touch are
    as one, unless fields end at each of them."""
    keys = {"Fields/Names": "o", "Fields/o/Diffusion": 1000, "Fields/o/Consumption": 1,
            "Fields/o/Fixed where": 1, "Fields/o/Value": 1, "Time/End time": 0.1}
    one = points_scene(runs, block(0, 60, "a"), [[rectangle(0, 60)]])
    whole = runs.run("whole", one, {**keys, "Contact/Between": "none"}).statistics["o_min"][0]
    pressed = {**blocks(runs, 1e-4), **press(60, "5*t"), **keys}
    for between, ranks in (("bodies", 1), ("all", 2)):
        both = runs.run("both", pressed, {"Contact/Between": between}, ranks=ranks)
        assert abs(both.statistics["o_min"].iloc[[0, -1]] - whole).max() <= 0.01
    ends = runs.run("ends", pressed, {"Contact/Fields pass": "false"})
    assert ends.statistics["o_min"][0] > whole + 0.1


@pytest.mark.parametrize("keys, message", [
    ({"Contact/Fusion time": "1", **WHOLE}, "Bodies that fuse get a new"),
    ({"Contact/Friction": "-1"}, "Contact/Friction = '-1'"),
    ({"Contact/Stiffness": "0"}, "Contact/Stiffness = '0'"),
    ({"Contact/Between": "cells"}, "Contact/Between = 'cells'"),
    ({"Tissue/Points surface": "none"}, "Bodies touch with their boundary points"),
    ({"Cell types/Names": ""}, "Name the types of the cells"),
    ({"Growth/Law": "isotropic", "Growth/Isotropic/Stretch": "1 + t", **WHOLE},
     "let bodies pass through each other"),
    ({"Grid/Spacing": "100"}, "contact needs bodies of at least 0.4")])
def test_what_is_refused(runs, keys, message):
    assert message in runs.explain(blocks(runs, 10), keys, code=1)


def test_a_surface_around_both(runs):
    """is open for each of them, and one body has nothing to touch."""
    scene = points_scene(runs, block(0, 30, "a") + block(30, 60, "b"), [[rectangle(0, 60)]])
    assert "the surface of body 0 is open" in runs.explain(scene, code=1)
    assert "there is only one body" in runs.explain(scene, {"Contact/Bodies": "apart"})


def test_what_is_said(runs):
    text = runs.explain(blocks(runs, 10))
    assert "2 bodies; body 0: 450 cells" in text
    assert "body 1: 450 cells, 1800 um^2, surface 180 um" in text
    text = runs.explain(blocks(runs, 10), {
        "Contact/Friction": 0.25, "Contact/Fusion time": 0.5})
    assert "; friction 0.25 kPa day/um;" in text
    assert "; bodies that touch for 0.5 day fuse" in text


def disc_in_a_free_ring(runs, h, cell, end, keys=None):
    """A disc grows in a ring that nothing holds."""
    return runs.run("free", {
        "Dimension": 2, "Time/End time": end, "Time/Step": 0.2, "Output/Interval": 0.4,
        "Tissue/Shape": "sphere", "Tissue/Radius": 180, "Tissue/Cell spacing": cell,
        "Grid/Spacing": h, "Grid/Offset": "3, 7", "Cell types/Names": "ring, disc",
        "Cell types/disc/Where": "X^2 + Y^2 < 60^2", "Cell types/ring/Growth/Law": "none",
        "Cell types/disc/Material/Young's modulus": 1, "Contact/Between": "bodies",
        "Contact/Bodies": "cell type", "Material/Young's modulus": 2,
        "Material/Poisson's ratio": 0.45, "Growth/Law": "rate",
        "Growth/Rate/Rate": "0.7*max(0, 1 - pressure/1)",
        "Division by size/Volume": 2 * cell**2, "Division by size/Noise": 0.1}, keys or {})


@pytest.mark.parametrize("offset, seed", [("14, 22", 12), ("5, 26", 4)])
def test_a_disc_stays_in_its_ring(runs, offset, seed):
    """The ring is stretched threefold. Where the drag within a step becomes weak, the
    disc slides off along its frozen normals: then it is tried again with the whole drag."""
    run = disc_in_a_free_ring(runs, 30, 10, 6, {"Grid/Offset": offset, "Random seed": seed})
    assert run.statistics["rejected_steps"].sum() <= 1


@pytest.mark.parametrize("h, cell, end, within", [(30, 10, 6, 4e-3), (10, 4, 3, 1e-3)])
def test_free_bodies_do_not_turn_together(runs, h, cell, end, within):
    """Where normals are frozen a common rotation has a negative stiffness; what
    holds it bears next to nothing, but where a disc has two grid spacings."""
    run = disc_in_a_free_ring(runs, h, cell, end)
    steps = run.statistics
    assert steps["rejected_steps"].sum() == 0
    assert steps["newton_iterations"].max() <= 20
    assert steps["linear_iterations"].max() <= 1000
    between, held = contact_rows(run), contact_rows(run, "contact")
    arm = between["area"] / (2 * np.pi)
    bears = abs(held["moment_z"].to_numpy()) / (between["force_inward"] * arm).to_numpy()
    assert bears.max() <= within, bears
