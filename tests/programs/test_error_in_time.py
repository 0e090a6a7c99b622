# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a run says of its error in time, doc/theory.md (5.10), against the error that runs
with Step, Step/2 and Step/4 show; and loads that are there at t = 0 (section 5.6)."""
import numpy as np
import pytest
from morula.error_in_time import error_in_time

from tests.common.program import TESTS, assert_same_run

TISSUE = {"Dimension": 2, "Output/Formats": "csv", "Output/Interval": 0,
          "Tissue/Surface": "tracked"}
SLAB = {**TISSUE, "Tissue/Shape": "box", "Tissue/Size": "100, 40", "Tissue/Cell spacing": 5,
        "Grid/Spacing": 20, "Boundary conditions/Slip where": "X < -49.99 || Y < -19.99"}
PULLED = {**SLAB, "Boundary conditions/Traction where": "X > 49.99"}
CREEP = {**PULLED, "Boundary conditions/Traction": "0.06; 0; 0", "Material/Relaxation time": 0.5,
         "Material/Volumetric strain": "pointwise", "Time/End time": 2, "Time/Step": 0.125}
DISC = {**TISSUE, "Tissue/Shape": "sphere", "Tissue/Radius": 80, "Tissue/Cell spacing": 8,
        "Grid/Spacing": 25}
SCENES = {
    "creep": CREEP,
    "ramped-creep": {**CREEP, "Boundary conditions/Traction": "0.06*min(2*t, 1); 0; 0"},
    "growth-under-stress": {
        **DISC, "Time/End time": 4, "Time/Step": 0.4, "Growth/Law": "rate",
        "Material/Young's modulus": "if(X^2 + Y^2 < 40^2, 1, 4)",
        "Growth/Rate/Rate": "0.5*(X^2 + Y^2 < 40^2)*max(0, 1 - pressure)"},
    "oxygen": {
        **SLAB, "Time/End time": 2, "Time/Step": 0.2, "Material/Relaxation time": 0.1,
        "Fields/Names": "oxygen", "Fields/oxygen/Diffusion": 1.7e8,
        "Fields/oxygen/Consumption": "4e6*oxygen/(2 + oxygen)", "Fields/oxygen/Initial": 40,
        "Fields/oxygen/Fixed where": "X > 49.99", "Fields/oxygen/Value": 40,
        "Growth/Law": "rate", "Growth/Rate/Rate": "0.6*hill(oxygen, 20, 2)"},
    "drop": {
        **DISC, "Time/End time": 0.4, "Time/Step": 0.1, "Tissue/Shape": "ellipsoid",
        "Tissue/Size": "200, 100", "Material/Relaxation time": 0.1,
        "Boundary conditions/Surface tension": 4},
    "wound": {
        **DISC, "Time/End time": 0.8, "Time/Step": 0.1, "Tissue/Radius": 150,
        "Tissue/Inner radius": 60, "Tissue/Surface cells": "trimmed", "Grid/Spacing": 28,
        "Material/Poisson's ratio": 0.45, "Material/Relaxation time": 0.1,
        "Boundary conditions/Surface tension where": "X^2 + Y^2 < 100^2",
        "Boundary conditions/Surface tension": 2},
    "homeostasis": {
        **PULLED, "Boundary conditions/Traction": "0.1; 0; 0", "Time/End time": 4,
        "Time/Step": 0.25, "Growth/Law": "rate", "Growth/Rate/Rate": 0,
        "Growth/Rate/Homeostasis": 1, "Growth/Rate/Homeostatic stress": 0.05},
    "contact-with-flow": {
        **SLAB, "Time/End time": 2, "Time/Step": 0.2, "Tissue/Size": "100, 60",
        "Boundary conditions/Slip where": "X < -49.99", "Material/Relaxation time": 0.5,
        "Material/Poisson's ratio": 0.45, "Body force/Force density": "0; -0.001",
        "Obstacles/Names": "floor", "Obstacles/floor/Shape": "plane",
        "Obstacles/floor/Center": "0, -30", "Obstacles/floor/Normal": "0, 1"},
    "cut": {
        **CREEP, "Tissue/Size": "100, 80", "Boundary conditions/Traction": "0.05; 0; 0",
        "Boundary conditions/Slip where": "X < -49.99 || Y < -39.99",
        "Death/When": "t >= 1 && abs(X) < 10.1 && Y > 20", "Death/Shrinking time": 0},
    "division-by-stress": {
        **PULLED, "Time/End time": 2, "Time/Step": 0.2, "Material/Relaxation time": 0.5,
        "Boundary conditions/Traction": "0.05; 0; 0", "Growth/Law": "rate",
        "Growth/Rate/Rate": "0.5*max(0, 1 - pressure)", "Division by size/Volume": 40,
        "Proliferation/Cell cycle/Division axis": "stress"}}
QUICK = ("creep", "homeostasis", "cut")


def size(table):
    """Logarithms of volume, width and height at the end: the error of one is a strain."""
    last = table.iloc[-1]
    return np.log([last.total_volume, last.xmax - last.xmin, last.ymax - last.ymin])


@pytest.mark.parametrize("name", [
    pytest.param(name, marks=() if name in QUICK else pytest.mark.release) for name in SCENES])
def test_stated_error(runs, name):
    """Between 0.3 and 3 times the largest error of volume, width and height, whose limits
    are extrapolated with the order that they show, from one to two."""
    tables = [runs.run(f"{name}-{parts}", SCENES[name], {
        "Time/Step": SCENES[name]["Time/Step"] / parts}).statistics for parts in (1, 2, 4)]
    whole, half, quarter = (size(table) for table in tables)
    ratio = np.abs(whole - half) / np.maximum(np.abs(half - quarter), 1e-12)
    limit = quarter - (half - quarter) / (np.clip(ratio, 2, 4) - 1)
    true = np.abs(whole - limit).max()
    stated = error_in_time(tables[0])
    print(f"{name}: stated {stated:.3%}, true {true:.3%}")
    assert 0.3 < stated / true < 3


def test_creep_under_a_load_of_t_0(runs):
    """The bar of the scene "creep", twice as long: within 1 % in steps of a quarter of the
    relaxation time, and of second order. A load that begins at 0 changes nothing at t = 0."""
    def ends(step, **keys):
        return runs.run("creep", {**CREEP, "Time/End time": 4}, {
            "Time/Step": step, **keys}).statistics["xmax"]
    bars = {step: ends(step) - 50 for step in (0.25, 0.125, 0.0625)}
    first, second, third = (bar.iloc[-1] for bar in bars.values())
    assert abs(second / 67.105 - 1) < 0.01
    assert np.log2((second - first) / (third - second)) > 1.8
    # The elastic part: sigma (1 - nu^2) / E and more, at once.
    assert 5 < bars[0.125][0] < 5.6
    ramped = {"Boundary conditions/Traction": "0.06*min(2*t, 1); 0; 0"}
    assert ends(0.125, **ramped)[0] == 50
    assert ends(0.125, **{"Method": "paper"})[0] == 50


PRESSED = {**SCENES["division-by-stress"], "Time/End time": 0.4, "Output/Interval": 0.2,
           "Material/Young's modulus": "growth", "Obstacles/Names": "wall",
           "Obstacles/wall/Shape": "plane", "Obstacles/wall/Center": "0, 19",
           "Obstacles/wall/Normal": "0, -1", "Solver/Newton tolerance": 1e-11}


def test_balance_on_ranks_and_resumed(runs):
    """With a stiffness that follows the growth, and an obstacle inside the tissue."""
    one = runs.run("one", PRESSED)
    assert one.statistics["ymax"][0] < 19.5
    assert one.statistics["xmax"][0] > 52
    assert (one.statistics["step"] == range(3)).all()
    several = runs.run("several", PRESSED, ranks=3).statistics
    for name in ("total_volume", "xmax", "ymax"):
        np.testing.assert_allclose(one.statistics[name], several[name], rtol=1e-9)
    np.testing.assert_array_equal(one.statistics["cells"], several["cells"])
    assert_same_run(one, runs.resumed("parts", PRESSED, {}, 0.2))


def test_friction_takes_time(runs):
    """So that nothing moves at t = 0."""
    table = runs.run("friction", PRESSED, {"Friction/Coefficient": 1e-4}).statistics
    assert table["ymax"][0] == 20 and table["xmax"][0] == 50


def test_a_lumen_keeps_its_content(runs):
    """Where the tissue gives way to its surface tension at t = 0."""
    table = runs.run("lumens", TESTS.parent / "prm/examples/two-lumens.prm", {
        "Time/End time": 0.05, "Output/Formats": "csv", "Output/Interval": 0}).statistics
    assert 0.99 < table["total_volume"][0] / 17664 < 0.995
    assert abs(table["lumen_volume_left"][0] / 1239.457576 - 1) < 1e-6
    assert 0.06 < table["lumen_pressure_left"][0] < 0.07
