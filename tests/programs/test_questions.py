# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Questions of users, as small scenes: each has its right value, or a word."""
import numpy as np
import pytest

from tests.common.program import without_wall_time

OFFSETS = ("0, 0", "3, 0", "10, 7", "17, 5")
WHERE = "Boundary conditions/"
BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Time/End time": 0.2,
       "Time/Step": 0.1, "Output/Formats": "none"}
HELD = {**BOX, WHERE + "Fixed where": "X < -49.9"}
PULLED = {**HELD, WHERE + "Traction where": "X > 49.9"}


def time_of_gap(said):
    """Since when the surface faces itself, day."""
    before = said.split(" day on two surfaces face each other")[0]
    return float(before.rsplit("from t = ", 1)[1])


def test_bodies_near_each_other(runs):
    """Cells of 5 um, a gap of 30 um: apart, or a word."""
    rows = [f"{x},{y},25" for y in np.arange(-22.5, 25, 5)
            for x in (*np.arange(-97.5, -20, 5), *np.arange(12.5, 90, 5))]
    file = runs.write("bodies.csv", "\n".join(["x,y,volume", *rows]))
    keys = {"Dimension": 2, "Time/End time": 0.3, "Time/Step": 0.1, "Tissue/Shape": "points",
            "Tissue/Points file": file, "Grid/Spacing": 20, "Output/Formats": "csv",
            "Output/Interval": 0.3, WHERE + "Fixed where": "X < -97",
            WHERE + "Traction where": "X > 87", WHERE + "Traction": "0.02*t; 0"}
    found = [runs.run(f"near-{offset[:2]}", keys, {"Grid/Offset": offset}) for offset in OFFSETS]
    apart = [run for run in found if "stick together from the start" not in run.said]
    assert apart
    for run in apart:
        # the right body flies, the left one does not know of it
        surface = run.surface(1)
        left = surface.query("X < 0")
        assert abs(left["x"] - left["X"]).max() < 1e-6
        assert abs(surface["x"].max() - 90.339) <= 0.01


@pytest.mark.parametrize("offset", [OFFSETS[0], OFFSETS[2]])
def test_hole_that_closes(runs, offset):
    run = runs.run("hole", {
        "Dimension": 2, "Time/End time": 0.9, "Time/Step": 0.025, "Tissue/Radius": 200,
        "Tissue/Inner radius": 80, "Tissue/Cell spacing": 4,
        "Grid/Spacing": 20, "Grid/Offset": offset, "Material/Poisson's ratio": 0.3,
        WHERE + "Fixed where": "X^2 + Y^2 > 190^2",
        WHERE + "Surface tension where": "X^2 + Y^2 < 90^2", WHERE + "Surface tension": "100*t",
        "Output/Formats": "csv", "Output/Interval": 0.3})
    assert run.said.count("does not resolve so narrow a gap") == 1
    assert 0.5 < time_of_gap(run.said) < 0.8
    rim = run.surface(2).query("X**2 + Y**2 < 90**2")
    assert abs(np.hypot(rim["x"], rim["y"]).mean() - 24.19) <= 1.5


def test_arms_that_join(runs):
    """A ring that is open at the right closes, on any ranks."""
    one, two = (runs.run("ring", {
        "Dimension": 2, "Time/End time": 1, "Time/Step": 0.05, "Tissue/Radius": 120,
        "Tissue/Inner radius": 80, "Tissue/Cell spacing": 8, "Grid/Spacing": 16,
        "Death/When": "X > 0 && abs(Y) < 28", "Death/Shrinking time": 0,
        "Growth/Law": "isotropic", "Growth/Isotropic/Stretch": "1 + 0.6*t*(X > 20)",
        "Output/Formats": "none"}, ranks=ranks).said for ranks in (1, 2))
    for said in (one, two):
        assert said.count("two surfaces face each other") == 1
    assert time_of_gap(one) > 0
    assert abs(time_of_gap(one) - time_of_gap(two)) <= 0.051


BAR = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "400, 40", "Tissue/Cell spacing": 5,
       "Grid/Spacing": 20, "Material/Poisson's ratio": 0, "Time/End time": 0.3, "Time/Step": 0.1,
       WHERE + "Fixed where": "X < -199.9", WHERE + "Traction where": "X > 199.9",
       WHERE + "Traction": "0.02; 0", "Output/Formats": "csv", "Output/Interval": 0.1}


@pytest.mark.parametrize("k, tip, offset", [
    *((1e-5, 5.419, offset) for offset in OFFSETS),
    (3e-5, 0.02 / np.sqrt(3e-5) * np.tanh(400 * np.sqrt(3e-5)), OFFSETS[0])])
def test_springs_to_the_ground(runs, k, tip, offset):
    """u'' = k u of a bar, with this law's strain: 5.419 um at the tip, from
    the first step on; linear 5.391 um."""
    run = runs.run("bar", BAR, {"Body force/Force density": f"-{k}*(x - X); 0",
                                "Grid/Offset": offset})
    for state in (1, 2, 3):
        end = run.surface(state).query("X > 199.9")
        assert abs((end["x"] - end["X"]).mean() / tip - 1) <= 0.01


def test_a_force_that_reads_the_state(runs):
    run = runs.run("state", BAR, {"Body force/Force density": "-1e-5*volume; 0"})
    assert "a force reads the state of its cell" in run.said


def test_load_that_jumps(runs):
    run = runs.run("jump", HELD, {
        "Tissue/Cell spacing": 5, "Grid/Spacing": 20, "Time/End time": 0.6,
        WHERE + "Fixed where": "Y < -49.9", WHERE + "Pressure where": "Y > 49.9",
        WHERE + "Pressure": "1.5*(t > 0.45)"})
    force = run.forces.set_index(["time", "name"])["force_y"]
    assert abs(force[0.6, "fixed"] + force[0.6, "pressure"]) <= 1e-4


@pytest.mark.parametrize("step, first", [(0.1, 0.7), (0.05, 0.15), (0.3, 0.9)])
def test_time_is_the_decimal_that_is_written(runs, step, first):
    """7 * 0.1 is more than 0.7, and 3 * 0.05 is more than 0.15."""
    run = runs.run("decimal", PULLED, {
        "Time/Step": step, "Time/End time": first + step, "Output/Interval": step,
        WHERE + "Traction": f"0.01*(t <= {first}); 0"})
    pull = run.forces.query("name == 'traction'")["force_x"]
    np.testing.assert_allclose(pull[-2:], [1, 0], atol=1e-12)


@pytest.mark.parametrize("field", [
    {"Fields/u/Fixed where": 1, "Fields/u/Value": "300 + X + 2*Y"},
    {"Fields/u/Time": "transient", "Fields/u/Initial": "300 + X + 2*Y"}])
def test_axes_along_a_gradient_at_the_start(runs, field):
    run = runs.run("gradient", BOX, {
        "Tissue/Cell spacing": 5, "Grid/Spacing": 25, "Time/End time": 1.2, "Time/Step": 0.3,
        "Proliferation/Law": "cell cycle", "Proliferation/Cell cycle/Start": "together",
        "Proliferation/Cell cycle/Duration": 1,
        "Proliferation/Cell cycle/G0 exit rate": 0,
        "Proliferation/Cell cycle/Division axis": "gradient of u",
        "Fields/Names": "u", "Fields/u/Diffusion": 1e6, **field})
    pairs = run.lineage.table.query("parent >= 0").groupby("parent")[["x", "y"]]
    axes = (pairs.first() - pairs.last()).to_numpy()
    assert len(axes) == 400
    along = abs(axes @ [1, 2]) / np.sqrt(5)
    assert (along / np.linalg.norm(axes, axis=1)).min() > 0.999


@pytest.mark.parametrize("offset", OFFSETS[::2])
def test_drop_keeps_its_surface(runs, offset):
    run = runs.run("drop", {
        "Dimension": 2, "Time/End time": 5, "Time/Step": 0.05, "Tissue/Shape": "ellipsoid",
        "Tissue/Size": "240, 120", "Tissue/Cell spacing": 5,
        "Grid/Spacing": 20, "Grid/Offset": offset, "Material/Relaxation time": 0.1,
        WHERE + "Surface tension": 6,
        "Output/Formats": "none"})
    share = run.statistics["enclosed_volume"] / run.statistics["total_volume"]
    np.testing.assert_allclose(share / share[0], 1, atol=0.02)
    assert "the surface encloses" not in run.said


def test_snapshots_by_the_clock(runs):
    keys = {**PULLED, "Time/End time": 1, WHERE + "Traction": "0.05*t; 0"}
    often, never = (runs.run(f"clock-{minutes}", keys, {"Output/Snapshot minutes": minutes})
                    for minutes in (1e-9, 0))
    assert without_wall_time(often.directory) == without_wall_time(never.directory)
    assert never.timings.loc["snapshot", "calls"] == 1
    assert often.timings.loc["snapshot", "calls"] > 1


def test_what_is_applied_is_said(runs):
    keys = {**PULLED, WHERE + "Traction": "0.05*t; 0.01"}
    run = runs.run("said", keys)
    lines = ("Applied: fixed at 10 boundary points, 100 um, from (-50 -45) to (-50 45) um",
             "Applied: traction at 10 boundary points, 100 um, from (50 -45) to (50 45) um; "
             "force (1 1) kPa um in sum, 1.414 in magnitudes, at t = 0.2 day on the surface of "
             "t = 0", "Material: neo-Hookean, E = 1.0 kPa, nu = 0.4 (plane strain)")
    log, explained = (run.directory / "log.txt").read_text(), runs.explain(keys)
    for line in lines:
        assert line in run.said
        assert line in log
    for line in lines[:2]:
        assert line.split(" at ", 1)[1] in explained


@pytest.mark.parametrize("keys, word", [
    ({WHERE + "Fixed where": "X + Y < -90"}, "it acts on 2 boundary points"),
    ({WHERE + "Fixed where": "", WHERE + "Traction where": "X > 49.9",
      WHERE + "Traction": "0.01; 0"}, "nothing fixes the tissue")])
def test_words_on_what_is_applied(runs, keys, word):
    assert word in runs.explain(HELD, keys)
