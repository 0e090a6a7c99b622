# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""forces.csv and the forces of boundary points: what presses, holds and loads."""
import numpy as np
import pytest
from scipy.optimize import brentq

PLATES = {"Dimension": 2, "Time/End time": 1, "Time/Step": 0.25, "Tissue/Shape": "box",
          "Tissue/Size": "100, 100", "Tissue/Cell spacing": 5, "Grid/Spacing": 20,
          "Material/Poisson's ratio": 0.3,
          "Growth/Law": "isotropic", "Growth/Isotropic/Stretch": "1 + 0.2*t",
          "Boundary conditions/Slip where": "abs(Y) > 49.9", "Output/Formats": "csv",
          "Output/Interval": 0.5}
PULLED = {"Time/End time": 0.4, "Time/Step": 0.2, "Tissue/Shape": "box",
          "Tissue/Size": "80, 60, 60", "Tissue/Cell spacing": 10, "Grid/Spacing": 25,
          "Boundary conditions/Fixed where": "X < -39.9",
          "Boundary conditions/Traction where": "X > 39.9",
          "Boundary conditions/Traction": "0.03*t; 0.01; 0",
          "Boundary conditions/Pressure where": "Y > 29.9", "Boundary conditions/Pressure": 0.05,
          "Body force/Force density": "0; 1e-4; 0", "Solver/Newton tolerance": 1e-10,
          "Output/Formats": "csv", "Output/Interval": 0.2}
PLANE = {"Dimension": 2, "Tissue/Size": "80, 60", "Boundary conditions/Traction": "0.03*t; 0.01",
         "Body force/Force density": "0; 1e-4"}
FORCES, MOMENTS = ([f"{kind}_{axis}" for axis in "xyz"] for kind in ("force", "moment"))


def force_between_plates(theta, width, E, nu):
    """Of neo-Hookean tissue in plane strain whose height stays, kPa um per um;
    energy per grown volume: theory, section 1."""
    mu, lame = E / 2 / (1 + nu), E * nu / (1 + nu) / (1 - 2 * nu)
    b = 1 / theta
    a = brentq(lambda a: mu * (a * a - 1) + lame * np.log(a * b), 0.5, 2)
    return -width * theta**2 * (mu * (b * b - 1) + lame * np.log(a * b))


@pytest.mark.parametrize("offset, ranks", [("0, 0", 1), ("3, 7", 2), ("10, 10", 1), ("17, 5", 1)])
def test_plates(runs, offset, ranks):
    expected = force_between_plates(1.2, 100, 1, 0.3)
    assert abs(expected - 25.858) <= 1e-3
    run = runs.run("plates", PLATES, {"Grid/Offset": offset}, ranks=ranks)
    assert [*run.forces["time"]] == [0.5, 1]
    last = run.forces.iloc[-1]
    assert (last["kind"], last["name"], last["points"]) == ("condition", "slip", 40)
    assert abs(last["force_inward"] / 2 / expected - 1) <= 1e-3
    assert abs(last["force_y"]) <= 1e-3 * expected
    surface = run.surface(2)
    for side in (-1, 1):
        plate = surface[side * surface["Y"] > 49.9]
        assert len(plate) == 20
        assert abs(-side * plate["force_y"].sum() / expected - 1) <= 1e-3
    free = surface[abs(surface["Y"]) < 49.9]
    assert abs(free[["force_x", "force_y"]]).max().max() == 0


@pytest.mark.parametrize("keys, has_moments", [
    ({}, True), (PLANE, True),
    # With the form of the paper the traction's variation has a moment of its own, gap
    # times traction.
    ({**PLANE, "Boundary conditions/Nitsche form": "symmetric"}, False)])
def test_loads_and_reactions_balance(runs, keys, has_moments):
    """In space and in the plane, with the form of the paper, too."""
    rows = runs.run("pulled", PULLED, keys).forces
    assert len(rows) == 8
    for time, now in rows.groupby("time"):
        for names in (FORCES, MOMENTS) if has_moments else (FORCES,):
            assert abs(now[names].sum()).max() < 1e-6 * abs(now[names]).max().max(), time
    last = rows.iloc[-4:].set_index("name")
    width = 60 if keys else 60 * 60
    assert abs(last.loc["body force", "force_y"] - 1e-4 * 80 * width) <= 1e-9 * 80 * width
    assert abs(last.loc["traction", "force_x"] - 0.012 * width) <= 1e-9 * width
    # a pressure presses on the area of the day
    pressure = last.loc["pressure"]
    assert abs(pressure["force_inward"] / pressure["area"] - 0.05) <= 1e-10


def test_refined_surface(runs):
    """Patches that are split share their force."""
    run = runs.run("refined", PLATES, {"Time/End time": 1.5,
                                       "Tissue/Boundary points": 40})
    for number, inward in enumerate(run.forces["force_inward"]):
        surface = run.surface(number + 1)
        above = surface["force_y"][surface["Y"] > 0]
        assert abs(-above.sum() / inward - 0.5) <= 1e-3
    assert len(surface) > 40


def test_lumen(runs):
    """Its pressure on all around, which adds up to nothing."""
    run = runs.run("lumen", {
        "Dimension": 2, "Time/End time": 0.2, "Time/Step": 0.1, "Tissue/Radius": 100,
        "Tissue/Inner radius": 60, "Tissue/Cell spacing": 5, "Grid/Spacing": 20,
        "Boundary conditions/Lumen where": "X^2 + Y^2 < 80^2",
        "Boundary conditions/Lumen volume": "1 + 0.5*t", "Output/Formats": "none"})
    row, pressure = run.forces.iloc[-1], run.statistics["lumen_pressure"].iloc[-1]
    assert (row["kind"], row["name"]) == ("lumen", "lumen")
    assert pressure > 0
    assert abs(row["force_inward"] / row["area"] / pressure - 1) <= 0.02
    assert abs(row["force_x"]) < 0.02 * row["force_inward"]


def test_nothing_without_conditions(runs):
    run = runs.run("free", PLATES, {"Boundary conditions/Slip where": ""})
    assert not (run.directory / "forces.csv").exists()
    assert "force_x" not in run.surface(1).columns
