# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""No constant that decides a result has a unit: a scene that is slower, larger and
stiffer by powers of two has the same events, and the same places and volumes but for
rounding. A quantity with a unit is written as 0.7[1/day], and stands for its number in
the units of the run."""
import re

import numpy as np
import pytest

from tests.common.results import read_csv

# Values with units that the keys have if a scene does not set them.
USUAL = {"Dimension": 2, "Time/Step": "0.1[day]", "Time/Smallest step": "1e-4[day]",
         "Tissue/Cell spacing": "8[um]", "Grid/Spacing": "24[um]",
         "Material/Young's modulus": "1[kPa]",
         "Output/Formats": "csv", "Output/Interval": "0.5[day]"}
DYING = {"Death/Rate": "0.3[1/day]", "Death/Shrinking time": "0.36[day]"}
DISC = {**USUAL, "Tissue/Radius": "64[um]", "Time/End time": "2[day]"}
POOLED = {"Material/Energy per": "grown volume", "Material/Volumetric strain": "pooled"}
FLOW = {**POOLED, "Material/Relaxation time": "0.1[day]", "Tissue/Refine surface": "true"}
BY_SIZE = {"Growth/Law": "rate", "Growth/Rate/Rate": "0.7[1/day]",
           "Division by size/Volume": "90[um^2]", "Division by size/Noise": 0.1}
CYCLE = "Proliferation/Cell cycle/"
CYCLES = {"Proliferation/Law": "cell cycle", CYCLE + "Duration": "normal(0.7[day], 0.05[day])",
          CYCLE + "G0 exit rate": "3[1/day]"}
TYPES = {"Cell types/Names": "a, b", "Cell types/b/Where": "sin(0.9[1/um]*X + 0.3[1/um]*Y) > 0",
         "Cell types/a/Tension/With b": "0.5[kPa*um]",
         "Cell types/a/Tension/With surface": "1[kPa*um]",
         "Cell types/b/Tension/With surface": "1.5[kPa*um]"}

# Times of division are rounded to 1e-6 of a step: with the first seed one lies between
# two of those.
SCENES = {
    "spheroid": {**DISC, **FLOW, **BY_SIZE, "Random seed": 2, "Fields/Names": "food",
                 "Fields/food/Diffusion": "2000[um^2/day]",
                 "Fields/food/Consumption": "2[1/day]", "Fields/food/Fixed where": 1,
                 "Fields/food/Value": 1, "Growth/Rate/Rate": "0.7[1/day]*food",
                 **DYING, "Death/Rate": "0.3[1/day]*(depth > 30[um])",
                 "Boundary conditions/Surface tension": "2[kPa*um]"},
    "cycles": {**DISC, **CYCLES, **DYING, **POOLED, CYCLE + "Size checkpoint": 0.9,
               CYCLE + "Division axis": "stress", "Time/Tolerance": 0.01,
               "Boundary conditions/Pressure where": 1,
               "Boundary conditions/Pressure": "0.05[kPa]",
               "Friction/Coefficient": "1e-4[kPa*day/um^2]", "Fields/Names": "signal",
               "Fields/signal/Time": "transient", "Fields/signal/Diffusion": "300[um^2/day]",
               "Fields/signal/Production": "1[1/day]*(x > 0)",
               "Death/Rate": "0.2[1/day]*signal*max(0, pressure/1[kPa])"},
    "crypt": {**USUAL, **FLOW, **BY_SIZE, "Time/End time": "2[day]", "Tissue/Shape": "box",
              "Tissue/Size": "80[um], 160[um]", "Tissue/Center": "0, 80[um]",
              "Growth/Rate/Rate": "0.8[1/day]*(y < 80[um])",
              "Extrusion/Rate": "3[1/day]*ramp(y, 130[um], 160[um])",
              "Obstacles/Names": "left, right, base", "Obstacles/left/Shape": "plane",
              "Obstacles/left/Center": "-40[um], 0", "Obstacles/left/Normal": "1, 0",
              "Obstacles/right/Shape": "plane", "Obstacles/right/Center": "40[um], 0",
              "Obstacles/right/Normal": "-1, 0", "Obstacles/base/Shape": "plane",
              "Obstacles/base/Normal": "0, 1", "Obstacles/base/Two-sided": "true"},
    "slip": {**USUAL, **POOLED, **BY_SIZE, "Time/End time": "1.4[day]", "Tissue/Shape": "box",
             "Tissue/Size": "80[um], 80[um]", "Tissue/Refine surface": "true",
             "Tissue/Coarsen surface": "true",
             "Boundary conditions/Fixed where": "Y < -39.9[um]",
             "Boundary conditions/Slip where": "abs(X) > 39.9[um]",
             "Body force/Force density": "0; 1e-4[kPa/um]"},
    "exchanges": {**DISC, **FLOW, **BY_SIZE, **TYPES, "Rearrangement/Diffusion": "100[um^2/day]",
                  "Rearrangement/Fluctuation energy": "20[kPa*um^2]",
                  **DYING,
                  "Cell types/a/Transitions/To b": "0.5[1/day]*(neighbours_b == 0)"},
    "bodies": {**DISC, **FLOW, "Tissue/Shape": "points", "Time/End time": "1[day]",
               "Contact/Between": "bodies", "Contact/Friction": "0.01[kPa*day/um]",
               "Contact/Fusion time": "0.2[day]", **BY_SIZE,
               "Boundary conditions/Surface tension": "1[kPa*um]"},
    "lumen": {**DISC, **BY_SIZE, "Tissue/Inner radius": "40[um]", "Contact/Between": "all",
              "Growth/Rate/Share along": 0, "Growth/Rate/Direction": "radial",
              "Boundary conditions/Lumen where": "X^2 + Y^2 < (50[um])^2",
              "Boundary conditions/Lumen volume": 1, "Tissue/Refine surface": "true",
              "Tissue/Coarsen surface": "true"},
    "strip": {**USUAL, **DYING, **POOLED, "Time/End time": "1[day]", "Tissue/Shape": "box",
              "Tissue/Size": "160[um], 48[um]", "Tissue/Refine surface": "true",
              "Material/Yield stress": "0.1[kPa]", "Material/Relaxation time": "0.3[day]",
              "Boundary conditions/Fixed where": "X < -79.9[um]",
              "Boundary conditions/Displacement": "0; 4[um/day]*t; 0",
              "Boundary conditions/Traction where": "X > 79.9[um]",
              "Boundary conditions/Traction": "0.1[kPa/day]*t; 0; 0",
              "Contraction/Stretch": "1 - 0.1[1/day]*t", "Contraction/Direction": "0; 1; 0",
              "Death/When": "abs(x) < 10[um] && y > 8[um] && t > 0.4[day]",
              "Death/Rate": 0, "Death/Shrinking time": 0, "Fields/Names": "leak",
              "Fields/leak/Diffusion": "400[um^2/day]", "Fields/leak/Time": "transient",
              "Fields/leak/Flux": "3[um/day]", "Fields/leak/Flux where": "X > 79.9[um]",
              "Fields/leak/Transfer": "5[um/day]", "Fields/leak/Fixed where": "X < -79.9[um]"},
    "ball": {**USUAL, **FLOW, "Dimension": 3, "Tissue/Radius": "40[um]",
             "Time/End time": "1[day]", "Tissue/Cell spacing": "10[um]",
             "Grid/Spacing": "30[um]", "Growth/Law": "rate",
             "Growth/Rate/Rate": "1[1/day]*max(0, 1 - pressure/0.5[kPa])",
             "Division by size/Volume": "1400[um^3]", "Division by size/Noise": 0.1,
             **DYING},
}


POWERS = {"um": 8., "day": 32., "kPa": 64.}


def in_units(value, units):
    """The text of a value with its quantities as numbers, in units (um, day, kPa)."""
    def number(match):
        return repr(float(match[1]) * eval(match[2].replace("^", "**"), {}, units))
    return re.sub(r"([0-9.]+(?:e-?[0-9]+)?)\[([^\]]+)\]", number, str(value))


def discs(units):
    """Two discs of cells that nearly touch."""
    lattice = [(8.6 * i + 4.3 * (j % 2), 7.44 * j) for i in range(-6, 7) for j in range(-6, 7)]
    rows = [f"{units['um'] * (x + side)!r},{units['um'] * y!r}"
            for side in (-48., 48.) for x, y in lattice if x * x + y * y <= 40. ** 2]
    return "x,y\n" + "\n".join(rows) + "\n"


def run_in(runs, name, units, keys=()):
    scene = {key: in_units(value, units) for key, value in {**SCENES[name], **dict(keys)}.items()}
    if scene.get("Tissue/Shape") == "points":
        scene["Tissue/Points file"] = runs.write(f"{name}.csv", discs(units))
    return runs.run(f"{name}-{units['day']:g}", scene)


@pytest.mark.parametrize("name, units", [
    *[pytest.param(name, POWERS, id=name) for name in SCENES],
    pytest.param("strip", {"um": 1., "day": 25., "kPa": 3.}, id="strip, no powers of two")])
def test_units_of_time_length_and_stress_do_not_matter(runs, name, units):
    usual = run_in(runs, name, {"um": 1., "day": 1., "kPa": 1.})
    other = run_in(runs, name, units)
    a, b = (read_csv(run.directory / "lineage.csv") for run in (usual, other))
    assert list(a["id"]) == list(b["id"]) and list(a["parent"]) == list(b["parent"])
    np.testing.assert_allclose(b["birth_time"] / units["day"], a["birth_time"], rtol=1e-9,
                               atol=1e-9)
    a, b = (read_csv(sorted(run.directory.glob("cells-*.csv"))[-1]) for run in (usual, other))
    assert list(a["id"]) == list(b["id"])
    size = max(np.ptp(a[axis]) for axis in "xyz")
    for axis in "xyz":
        assert abs(b[axis] / units["um"] - a[axis]).max() <= 1e-8 * size
    dim = SCENES[name]["Dimension"]
    assert abs(b["volume"] / units["um"]**dim / a["volume"] - 1).max() <= 1e-8


SIDES = {"as it is": ("x", "y", [[1, 0], [0, 1]]), "mirrored": ("(-x)", "y", [[-1, 0], [0, 1]]),
         "turned": ("y", "(-x)", [[0, -1], [1, 0]])}


def seen_from(runs, side):
    """A square on a two-sided base that grows at one side, from this side."""
    a, b, turn = SIDES[side]
    down = np.array(turn) @ [0, -1]
    push = [f"{3e-5 * part:g}*t" for part in np.array(turn) @ [1, 2]]
    run = runs.run(side.replace(" ", "-"), {
        "Dimension": 2, "Time/End time": 1, "Time/Step": 0.1, "Tissue/Shape": "box",
        "Tissue/Size": "96, 96", "Tissue/Cell spacing": 8, "Grid/Spacing": 24,
        "Tissue/Refine surface": "true", "Tissue/Surface": "tracked", **POOLED,
        "Material/Relaxation time": 0.5, "Growth/Law": "rate",
        "Growth/Rate/Rate": f"0.4*({a} > 10) + 0.1*({b} > 20)",
        "Body force/Force density": "; ".join(push), "Friction/Coefficient": 1e-5,
        "Boundary conditions/Surface tension": 1, "Obstacles/Names": "base",
        "Obstacles/base/Shape": "plane", "Obstacles/base/Two-sided": "true",
        "Obstacles/base/Center": ", ".join(f"{48 * part}" for part in down),
        "Obstacles/base/Normal": ", ".join(f"{-part}" for part in down),
        "Solver/Newton tolerance": 1e-10, "Output/Formats": "csv", "Output/Interval": 1})
    cells = run.cells(1)
    places = {}
    for X, x, volume in zip(cells[["X", "Y"]].to_numpy(), cells[["x", "y"]].to_numpy(),
                            cells["volume"]):
        places[tuple(np.rint(X @ turn).astype(int))] = [*(x @ turn), volume]
    return places


@pytest.mark.parametrize("side", ["mirrored", "turned"])
def test_sides_do_not_matter(runs, side):
    one, other = seen_from(runs, "as it is"), seen_from(runs, side)
    assert one.keys() == other.keys() and len(one) == 144
    for place, values in one.items():
        np.testing.assert_allclose(other[place], values, rtol=0, atol=1e-6)


def test_what_rests_stays(runs):
    run = runs.run("rests", {**{key: in_units(value, {"um": 1, "day": 1, "kPa": 1})
                                for key, value in {**DISC, **FLOW}.items()},
                             "Time/End time": 10, "Output/Interval": 10})
    first, last = run.cells(0), run.cells(1)
    for axis in "xy":
        assert abs(last[axis] - first[axis]).max() <= 1e-12
