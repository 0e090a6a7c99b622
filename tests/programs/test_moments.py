# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Each expression is evaluated at the moments that its key names: in the barest
scene that has the key, its value is another one from a time on; with a field and
a number of cells it is so from where these and the age have come to a value. The
run is that of the first value until then, and another one after."""
import json

import numpy
import pytest


SWITCH = 0.25  # day
ROOM = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "40, 50",
        "Tissue/Cell spacing": 10, "Tissue/Redistribution": "false", "Grid/Spacing": 30,
        "Time/End time": 0.8, "Time/Step": 0.2, "Output/Formats": "csv", "Output/Interval": 0.2}
# Both are t, in all cells and at all times.
CLOCKS = {"Fields/Names": "u", "Fields/u/Time": "transient", "Fields/u/Diffusion": 1,
          "Fields/u/Production": 1, "Fields/u/Dilution": "false",
          "Cell numbers/Names": "n", "Cell numbers/n/Rate": 1}
HELD = {"Boundary conditions/Fixed where": "Y < -24"}
PULLED = {**HELD, "Body force/Force density": "0; 0.005"}
GROWS = {"Growth/Law": "rate", "Growth/Rate/Rate": 0.5}
ALONG = {**GROWS, "Growth/Rate/Direction": "0; 1; 0", "Growth/Rate/Share along": 0.8}
CYCLE_KEY = "Proliferation/Cell cycle/"
CYCLE = {"Proliferation/Law": "cell cycle", "Time/Step": 0.1, CYCLE_KEY + "Start": "waiting",
         CYCLE_KEY + "Duration": 0.4, CYCLE_KEY + "G0 exit rate": "50*(t > 0.4)"}
FIXED = {**CYCLE, CYCLE_KEY + "Division axis": "fixed"}
BY_SIZE = {"Growth/Law": "rate", "Growth/Rate/Rate": 1.0, "Division by size/Volume": 150}
DIES = {"Death/When": "t > 0.35", "Material/Energy per": "grown volume"}
MIXES = {"Rearrangement/Diffusion": 200, "Rearrangement/Fluctuation energy": 1}
EDGE = {"Fields/Names": "c", "Fields/c/Time": "transient", "Fields/c/Diffusion": 50}
LOADS = "Boundary conditions/"

# Key, value before, value after, the scene; which keys have cells is known by
# their variables.
SCENES = {
    "Material/Young's modulus": (1, 3, PULLED),
    "Material/Poisson's ratio": (0.3, 0.45, PULLED),
    "Material/Relaxation time": (5, 0.1, PULLED),
    "Material/Yield stress": (9, 0.001, {**PULLED, "Material/Relaxation time": 0.2}),
    "Growth/Isotropic/Stretch": (1.1, 1.3, {"Growth/Law": "isotropic"}),
    "Growth/Rate/Rate": (0.5, 1, GROWS),
    "Growth/Rate/Share along": (0.5, 1, ALONG),
    "Growth/Rate/Direction": ("{}; {}", ((0, 1), (1, 0)), ALONG),
    "Growth/Rate/Homeostasis": (0.1, 5, {**GROWS, **HELD}),
    "Growth/Rate/Homeostatic stress": (0, 0.1, {**GROWS, **HELD, "Growth/Rate/Homeostasis": 1}),
    CYCLE_KEY + "Duration": (0.6, 0.3, CYCLE),
    CYCLE_KEY + "G0 exit rate": (0, 50, {**CYCLE, CYCLE_KEY + "Duration": 0.2}),
    CYCLE_KEY + "Size checkpoint": (2, 0, {**CYCLE, CYCLE_KEY + "Duration": 0.2,
                                          CYCLE_KEY + "G0 exit rate": 50}),
    CYCLE_KEY + "Axis spread": (0, 1, {**FIXED, CYCLE_KEY + "Fixed axis": "1; 0; 0"}),
    CYCLE_KEY + "Least anisotropy": (1, 100, {**CYCLE, **PULLED,
                                             CYCLE_KEY + "Division axis": "cell shape"}),
    CYCLE_KEY + "Fixed axis": ("{}; {}; 0", ((0, 1), (1, 0)), FIXED),
    CYCLE_KEY + "Radial center": ("{}; {}; 0", ((0, 0), (99, 0)), {
        **CYCLE, CYCLE_KEY + "Division axis": "radial"}),
    "Contraction/Stretch": (1, 0.8, {"Contraction/Direction": "0; 1; 0"}),
    "Contraction/Direction": ("{}; {}; 0", ((0, 1), (1, 0)), {
        "Contraction/Stretch": "1 - 0.1*t"}),
    "Division by size/Volume": (900, 105, BY_SIZE),
    "Division by size/Noise": (0, 0.4, {**BY_SIZE, "Division by size/Volume": 160}),
    "Division/Rate": (0, 9, GROWS),
    "Death/Rate": (0, 9, {}),
    "Death/When": (0, 1, {"Death/Rate": 1e-9}),
    "Death/Shrinking time": (0.4, 0.1, {**DIES, "Death/When": "t > 0.35 && X < 0"}),
    "Death/Final volume": (0.05, 0.5, {**DIES, "Death/When": "t > 0.35 && X < 0"}),
    "Death/Keep debris": (0, 1, {**DIES, "Death/When": "t > 0.35 && X < 0",
                                 "Death/Shrinking time": 0.1}),
    "Extrusion/Rate": (0, 9, {}),
    "Fields/c/Diffusion": (1, 900, {**EDGE, "Fields/c/Initial": "1 + X/100"}),
    "Fields/c/Production": (0, 1, {**EDGE, "Fields/c/Initial": 1}),
    "Fields/c/Consumption": (0, 1, {**EDGE, "Fields/c/Initial": 1}),
    "Fields/c/Value": (1, 2, {**EDGE, "Fields/c/Fixed where": "X < -19"}),
    "Fields/c/Transfer": (1, 99, {**EDGE, "Fields/c/Value": 1}),
    "Fields/c/Flux": (1, 9, {**EDGE, "Fields/c/Flux where": "X < -19"}),
    "Rearrangement/Diffusion": (0, 99, {}),
    "Rearrangement/Drive": ("{}*(X > 0); {}; 0", ((0, 0), (-9, 0)), MIXES),
    LOADS + "Displacement": ("{}; {}; 0", ((0, 0), (0, 1)), HELD),
    LOADS + "Traction": ("{}; {}; 0", ((0, 0), (0.05, 0)), {
        **HELD, LOADS + "Traction where": "Y > 24"}),
    LOADS + "Pressure": (0, 0.1, {**HELD, LOADS + "Pressure where": "Y > 24"}),
    LOADS + "Surface tension": (0, 1, HELD),
    "Obstacles/o/Velocity": ("{}; {}; 0", ((0, 0), (0, -9)), {
        **HELD, "Obstacles/Names": "o", "Obstacles/o/Shape": "plane",
        "Obstacles/o/Center": "0, 25", "Obstacles/o/Normal": "0, -1"}),
    "Body force/Force density": ("{}; {}; 0", ((0, 0), (0, 0.005)), HELD),
    "Friction/Coefficient": (1e-3, 1, {"Body force/Force density": "0; 0.005*(Y > 0)",
                                      **HELD}),
    "Cell types/a/Transitions/To b": (0, 9, {"Cell types/Names": "a, b"}),
    "Cell numbers/m/Initial": (0, 1, {
        "Cell numbers/Names": "m", "Cell numbers/m/At division": "new", **CYCLE,
        CYCLE_KEY + "Duration": 0.2}),
    "Cell numbers/m/Rate": (1, 2, {"Cell numbers/Names": "m"}),
}
LUMENS = "umen"  # tests/programs/test_folds.py and others


def switched(name, condition):
    """The value of a key that is the second one where the condition holds."""
    first, second, _ = SCENES[name]
    if isinstance(first, str):
        return first.format(*(f"if({condition}, {b}, {a})" for a, b in zip(*second)))
    return f"if({condition}, {second}, {first})"


OF_PLACES = {"Fields/c/Value", "Fields/c/Transfer", "Fields/c/Flux", "Obstacles/o/Velocity"} | {
    name for name in SCENES if name.startswith(LOADS)}


@pytest.mark.parametrize("name", SCENES)
def test_value_changes(runs, name):
    keys = {**ROOM, **SCENES[name][2]}
    keys.pop(name, None)
    never = runs.run("never", keys, {name: switched(name, "0")}, "--replace")
    changed = [runs.run("time", keys, {name: switched(name, f"t > {SWITCH}")}, "--replace")]
    if name not in OF_PLACES:
        words = ["n", "age"] if name.startswith(("Material/Y", "Material/P")) else ["n", "age", "u"]
        condition = " && ".join(f"{word} > {SWITCH}" for word in words if (
            word != "age" or name != "Cell numbers/m/Initial"))
        both = {key: f"{value}, {keys[key]}" if key.endswith("/Names") and key in keys else value
                for key, value in CLOCKS.items()}
        changed.append(runs.run("state", {**keys, **both}, {name: switched(name, condition)},
                                "--replace"))
    for run in changed:
        before, right = run.cells(1), never.cells(1)
        columns = [column for column in right if column in before]
        numpy.testing.assert_allclose(before[columns], right[columns], rtol=1e-6, atol=1e-9)
        last, other = (states.cells(-1)[columns] for states in (run, never))
        assert len(last) != len(other) or abs(last - other).to_numpy().max() > 1e-4


def test_all_keys(runs):
    """No key of which the value may change in a run is forgotten here."""
    scene = runs.write("names.prm", "set Dimension = 2\n" + "".join(
        f"subsection {section}\n set Names = {names}\nend\n" for section, names in (
            ("Fields", "c"), ("Cell numbers", "m"), ("Obstacles", "o"), ("Cell types", "a, b"))))
    keys = json.loads(runs.call(runs.command(scene, "--parameters=json")).text)
    change = {key["path"] for key in keys if "t" in key.get("variables", ())}
    change = {path for path in change if LUMENS not in path and (
        not path.startswith("Cell types/") or path == "Cell types/a/Transitions/To b")}
    assert change == set(SCENES)


def test_founders_see_steady_fields(runs):
    """A field that is sought first at 0.5, and is 1: the cycle takes a day."""
    keys = {**ROOM, **CLOCKS, "Fields/u/Time": "steady", "Fields/u/Production": 2,
            "Fields/u/Dilution": "true", "Fields/u/Consumption": 2, "Fields/u/Initial": 0.5,
            "Proliferation/Law": "cell cycle",
            CYCLE_KEY + "Start": "together", CYCLE_KEY + "Duration": "u",
            CYCLE_KEY + "G0 exit rate": 0, "Cell numbers/n/Initial": "3*u"}
    run = runs.run("steady", keys)
    born = run.lineage.table
    daughters = born[born["parent"] >= 0]
    numpy.testing.assert_allclose(daughters["birth_time"], 0.5, rtol=1e-6)
    numpy.testing.assert_allclose(born["n"][born["parent"] < 0], 3, rtol=1e-6)
    # Founders that are carved away have their rows, too.
    carved = runs.run("carved", keys, {"Death/When": "X > 0", "Death/Shrinking time": 0})
    assert len(carved.cells(0)) == 10
    assert (carved.lineage.parent < 0).sum() == 20
