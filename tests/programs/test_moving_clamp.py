# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A clamp that moves by many grid spacings in one step takes the tissue with it,
whatever else the step does: nothing but the place is another.
"""
import numpy
import pytest

from tests.common.program import assert_same_file
from tests.common.results import read_csv

SPACING = 25.0
FORM = "Boundary conditions/Nitsche form"
MOVES = "Boundary conditions/Displacement"
SCENE = {"Dimension": 2, "Time/End time": 1, "Time/Step": 0.5, "Tissue/Radius": 80,
         "Tissue/Cell spacing": 8, "Grid/Spacing": SPACING, "Growth/Law": "isotropic",
         "Growth/Isotropic/Stretch": "1 + 0.2*t*(1 + X/200)",
         "Boundary conditions/Fixed where": "Y < 0", "Boundary conditions/Nitsche penalty": 1000,
         "Solver/Newton tolerance": 1e-10, "Output/Formats": "csv", "Output/Interval": 0}


@pytest.mark.parametrize("form, ranks", [("symmetric", 1), ("unsymmetric", 2)])
def test_moves_with_the_clamp(runs, form, ranks):
    """20 spacings in the first step, 7 back in the second: by whole
    spacings, so that the grid lies in the tissue as it did."""
    rest = runs.run(f"rest-{form}", SCENE, {FORM: form})
    moving = runs.run(f"moving-{form}", SCENE, {
        FORM: form, MOVES: f"if(t < 0.75, {20 * SPACING}, {13 * SPACING}); "
                           f"if(t < 0.75, {-6 * SPACING}, {2 * SPACING}); 0"}, ranks=ranks)
    for run in (rest, moving):
        assert run.statistics["rejected_steps"].sum() == 0
    cells, moved = rest.cells(1), moving.cells(1)
    for name, shift, within in (("x", 13 * SPACING, 1e-6), ("y", 2 * SPACING, 1e-6),
                                ("energy_density", 0, 1e-7)):
        numpy.testing.assert_allclose(moved[name], cells[name] + shift, rtol=0, atol=within)
    # ... and as easily.
    assert (moving.statistics["newton_iterations"].sum()
            <= rest.statistics["newton_iterations"].sum() + 2)


@pytest.mark.parametrize("strain, iterations", [(0.02, 8), (0.1, 10), (0.3, 12), (0.6, 16)])
def test_a_clamp_that_widens(runs, strain, iterations):
    """No rigid motion: the inner side moves by 0.08 to 2.4 spacings in a step."""
    run = runs.run(f"widens-{strain}", {
        "Dimension": 2, "Time/End time": 1, "Time/Step": 1, "Tissue/Shape": "sphere",
        "Tissue/Radius": 100, "Tissue/Inner radius": 40, "Tissue/Cell spacing": 2,
        "Grid/Spacing": 10, "Material/Poisson's ratio": 0.4, "Output/Formats": "csv",
        "Boundary conditions/Fixed where": "X^2 + Y^2 < 4900",
        MOVES: f"{strain}*X; {strain}*Y; 0"})
    assert len(run.statistics) == 2
    assert run.statistics["newton_iterations"].sum() <= iterations


def test_at_rest_nothing_changes(runs):
    """A displacement that is constant in time is no motion after the first
    step."""
    one = runs.run("one", SCENE, {FORM: "symmetric"})
    other = runs.run("two", SCENE, {FORM: "symmetric", MOVES: "0*t; 0; 0"})
    assert_same_file(one.directory / "cells-0001.csv", other.directory / "cells-0001.csv")
    assert len(one.statistics) == 3


def test_a_sheet_of_one_layer(runs):
    """No strain resists its bending, so that a motion is left which need not come to rest:
    no solve takes all of Solver/Newton iterations, and the held traction settles."""
    run = runs.run("sheet", {
        "Dimension": 3, "Time/End time": 0.425, "Time/Step": 0.1, "Tissue/Shape": "box",
        "Tissue/Size": "100, 100, 6", "Tissue/Cell spacing": 6, "Grid/Spacing": 20,
        "Grid/Offset": "3, 1, 2", "Boundary conditions/Fixed where": "X < -49.9",
        "Growth/Law": "isotropic", "Growth/Isotropic/Stretch": "1 + 0.4*t*(X > 0)",
        "Output/Formats": "csv", "Output/Newton trace": "true"})
    trace = read_csv(run.directory / "newton.csv")
    assert trace["iteration"].max() < 100
    assert trace["turn"].max() <= 6
