# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cuts of no width: their faces press on each other and open."""
import re

import pytest

SCENE = {"Time/End time": 0.4, "Time/Step": 0.1, "Tissue/Shape": "box",
         "Tissue/Center": "30, 30, 10", "Tissue/Size": "60, 60, 20", "Tissue/Cell spacing": 2.5,
         "Grid/Spacing": 10, "Grid/Offset": "3, 7, 0", "Contact/Between": "all",
         "Boundary conditions/Fixed where": "Y > 59.999", "Material/Young's modulus": 1,
         "Material/Poisson's ratio": 0.4, "Output/Formats": "csv", "Output/Interval": 0.1}
LINE = "LINESTRING(-20 30, 30 30)\n"
PLANE = "OFF\n4 1 0\n-20 30 -5\n30 30 -5\n30 30 25\n-20 30 25\n4 0 1 2 3\n"


def keys_of(runs, cuts, dim=2):
    """The scene with these cuts, or none."""
    file = runs.write("cut.wkt" if dim == 2 else "cut.off", cuts) if cuts else ""
    sides = " || Z < 0.001 || Z > 19.999" if dim == 3 else ""
    coarse = {"Tissue/Cell spacing": 10 / 3} if dim == 3 else {}
    return {**SCENE, **coarse, "Dimension": dim, "Tissue/Cuts": file,
            "Boundary conditions/Slip where": "Y < 0.001" + sides}


def move(runs, cuts, way, dim=2, ranks=1):
    """The force on the upper side, and how far the faces are apart at the mouth of
    the cut, um, when that side moves by so much a day."""
    still = "; 0" if dim == 3 else ""
    run = runs.run(f"{dim}-{bool(cuts)}-{way}", keys_of(runs, cuts, dim), {
        "Boundary conditions/Displacement": f"0; {way}*t{still}"}, ranks=ranks)
    force = run.forces[run.forces["name"] == "fixed"].iloc[-1]["force_y"]
    points = run.surface(4)
    mouth = points[(abs(points["Y"] - 30) < 1e-6) & (points["X"] < 4)]
    upper = mouth["ny"] < 0
    return force, mouth["y"][upper].mean() - mouth["y"][~upper].mean()


@pytest.fixture(scope="module")
def flat(runs):
    """In 2-D: forces and openings with a cut and without, pressed and drawn."""
    return {(cuts, way): move(runs, cuts, way) for cuts in ("", LINE) for way in (-10, 10)}


def test_a_cut_carries_pressure_and_no_tension(flat):
    """as a slit does: under pressure the block is as without it."""
    assert abs(flat[LINE, -10][0] / flat["", -10][0] - 1) <= 3e-3
    assert abs(flat[LINE, -10][1]) < 0.05
    assert flat[LINE, 10][0] < 0.9 * flat["", 10][0]
    assert flat[LINE, 10][1] > 2.5


def test_in_3d_as_in_2d(runs, flat):
    """A block that cannot give way along z, on any ranks. The end of the cut
    is seen to within a grid spacing."""
    force, opening = move(runs, PLANE, -10, dim=3)
    assert abs(force / (20 * flat[LINE, -10][0]) - 1) <= 5e-3
    assert abs(opening) < 0.05
    force, opening = move(runs, PLANE, 10, dim=3, ranks=3)
    assert force < 0.9 * 20 * flat["", 10][0]
    assert abs(opening / flat[LINE, 10][1] - 1) <= 0.1


def test_what_is_said(runs):
    assert re.search(r"cuts +30 um in 12 patches on each side",
                     runs.explain(keys_of(runs, LINE)))


def test_far_ends_are_left_out(runs):
    explained = runs.explain(keys_of(runs, "LINESTRING(-1e9 30, 1e9 30)"))
    found = re.search(r"cuts +([0-9.]+) um in (\d+) patches", explained)
    # The piece at each end is halved three times.
    assert abs(float(found[1]) - 60) <= 2.5 / 4
    assert int(found[2]) < 40


@pytest.mark.parametrize("cuts, keys, message", [
    (LINE, {"Contact/Between": "none"}, "allowed is nothing, as Contact/Between = none"),
    ("LINESTRING(70 0, 70 60)", {}, "no place on them that has cells"),
    ("LINESTRING(0 31.25, 30 31.25)", {}, "cells have their middle"),
    ("LINE(0 30, 30 30)", {}, "LINESTRING or MULTILINESTRING"),
    ("LINESTRING(0 30, nan 30)", {}, "there is no number"),
    ("LINESTRING(0 30 0, 30 30 0)", {}, "are not two coordinates"),
    ("LINESTRING(0 30, inf 30)", {}, "there is no number"),
    (PLANE, {"Tissue/Cuts": "surface.off"}, "ends with .wkt")])
def test_what_is_refused(runs, cuts, keys, message):
    assert message in runs.explain(keys_of(runs, cuts), keys, code=1)
