# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Keys that a scene sets and nothing reads: each is said, and none without
cause."""
import re

import pytest

BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Time/End time": 0.2,
       "Time/Step": 0.1, "Output/Formats": "none"}
TYPES = {**BOX, "Cell types/Names": "a, b", "Cell types/b/Where": "X > 0"}
CYCLE = {**TYPES, "Proliferation/Law": "cell cycle", "Proliferation/Cell cycle/Duration": 0.2}
GROWS = {**TYPES, "Growth/Law": "isotropic", "Growth/Isotropic/Stretch": "1 + 0.1*t"}
RATE = {**TYPES, "Growth/Law": "rate", "Growth/Rate/Rate": 0.1}
MOVES = {**TYPES, "Rearrangement/Diffusion": 10}
FIELD = {**BOX, "Fields/Names": "u", "Fields/u/Diffusion": 100, "Fields/u/Consumption": 1,
         "Fields/u/Production": 1}

POINTS = {**{key: value for key, value in BOX.items() if key not
             in ("Tissue/Size", "Tissue/Cell spacing")}, "Tissue/Shape": "points"}

IDLE = (
    ("Tension/Force", "false", TYPES),
    ("Tension/Force", "false", {**TYPES, "Cell types/a/Tension/With b": 1}),
    ("Solver/Largest gap", 0.1, BOX),
    ("Cell types/b/Material/Yield stress", 0.3, TYPES),
    ("Cell types/b/Growth/Rate/Homeostatic stress", 0.3, RATE),
    ("Growth/Rate/Rate", 0.3, GROWS),
    ("Cell types/b/Growth/Rate/Rate", 0.3, GROWS),
    ("Proliferation/Cell cycle/Radial center", "1; 0; 0",
     {**BOX, "Proliferation/Law": "cell cycle",
      "Proliferation/Cell cycle/Division axis": "stretch"}),
    ("Fields/u/Dilution", "false", FIELD),
    ("Tissue/Radius", 30, BOX),
    ("Obstacles/wall/Radius", 30, {**BOX, "Obstacles/Names": "wall",
                                   "Obstacles/wall/Shape": "plane",
                                   "Obstacles/wall/Normal": "0, 1, 0",
                                   "Obstacles/wall/Center": "0, -60, 0"}),
    ("Cell numbers/dose/Split noise", 0.3, {**BOX, "Cell numbers/Names": "dose",
                                            "Cell numbers/dose/At division": "halved"}))

READ = (
    ("Growth/Rate/Rate", 0.3, {**TYPES, "Growth/Law": "none"}),  # switched off on purpose
    ("Tension/Force", "false", {**MOVES, "Cell types/a/Tension/With b": 1,
                                "Rearrangement/Fluctuation energy": 1}),
    ("Solver/Largest gap", 0.1,
     {**BOX, "Boundary conditions/Fixed where": "X < -49"}),
    ("Cell types/b/Growth/Rate/Rate", 0.3, RATE),
    ("Fields/u/Value", 3, {**FIELD, "Fields/u/Fixed where": "X > 49"}))


@pytest.mark.parametrize("key, value, keys", IDLE)
def test_said(runs, key, value, keys):
    lines = [line for line in runs.explain(keys, {key: value}).splitlines()
             if line.startswith(f"Warning: {key} = ")]
    assert len(lines) == 1
    assert "it does nothing" in lines[0]
    assert f"Warning: {key}" not in runs.explain(keys)


@pytest.mark.parametrize("key, value, keys", READ)
def test_not_said_of_what_is_read(runs, key, value, keys):
    assert "it does nothing" not in runs.explain(keys, {key: value})


def points(runs, columns):
    """A file of 100 cells, with columns that are the same in all rows."""
    rows = [",".join(map(str, (x, y, *columns.values())))
            for x in range(-45, 50, 10) for y in range(-45, 50, 10)]
    head = ",".join(["x", "y", *columns])
    return {"Tissue/Points file": runs.write("cells.csv", "\n".join([head, *rows]) + "\n")}


def test_columns_that_nothing_reads(runs):
    said = runs.explain(POINTS, points(runs, {"phase": 1, "id": 7}))
    assert "its columns 'id' are not known, and are skipped." in said


def test_key_twice(runs):
    """The last line counts, and both are named."""
    scene = runs.write("twice.prm", "set Grid/Spacing = 30\nsubsection Grid\n"
                                    "  set Spacing = 40\nend\n")
    said = runs.explain(scene, {key: BOX[key] for key in BOX if key != "Grid/Spacing"})
    assert re.search("twice.prm:3: the key 'Grid/Spacing' is set to '40', which counts; "
                     ".*twice.prm:1: it was set to '30'", said)
