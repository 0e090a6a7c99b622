# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/rounding-drop.prm and spheroid-in-a-mould.prm, on coarser lattices:
a drop rounds up, and tissue in a tube grows along it. A mould is the same from a
file."""
from tests.common.program import SCENES, TESTS

EXAMPLES = TESTS.parent / "prm/examples"
MOULD = "Obstacles/mould/"
BOX = ("OFF\n8 6 0\n-65 -62 -60\n65 -62 -60\n65 62 -60\n-65 62 -60\n-65 -62 60\n65 -62 60\n"
       "65 62 60\n-65 62 60\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n")


def last_row(runs, scene, keys):
    return runs.run(scene, EXAMPLES / f"{scene}.prm",
                    {"Output/Formats": "none", **keys}).statistics.iloc[-1]


def test_a_drop_rounds_up(runs):
    row = last_row(runs, "rounding-drop", {"Tissue/Cell spacing": 15, "Grid/Spacing": 50,
                                           "Time/End time": 1})
    length, width, height = (row[f"{axis}max"] - row[f"{axis}min"] for axis in "xyz")
    assert 1 < length / width < 1.25  # 2 at first
    assert abs(width / height - 1) <= 0.02


def test_a_spheroid_fills_a_tube(runs):
    row = last_row(runs, "spheroid-in-a-mould", {"Time/End time": 2.5})
    for axis in "xy":
        assert 62 < row[f"{axis}max"] < 63.5
        assert row[f"{axis}min"] > -63.5
    assert row["zmax"] - row["zmin"] > 170


def test_a_mould_from_a_file(runs):
    """The ball of the scene mould grows in a box, which a file describes, too.
    A place and a step with which no step fails: the ball is free to slide, and
    steps that are halved would end elsewhere."""
    rows = []
    for keys in ({MOULD + "Shape": "box", MOULD + "Size": "130, 124, 120"},
                 {MOULD + "Shape": "mesh", MOULD + "Surface mesh": runs.write("box.off", BOX)}):
        table = runs.run("mould", SCENES / "mould.prm", {
            "Tissue/Cell spacing": 12, "Grid/Spacing": 30, "Grid/Offset": "14, 1, 9",
            "Time/Step": 0.05, "Time/End time": 0.5, "Output/Formats": "none",
            MOULD + "Center": "1, 2, 3", **keys}).statistics
        assert table["rejected_steps"].sum() == 0
        rows.append(table.iloc[-1])
    for name in ("total_volume", "mean_energy_density", "xmin", "xmax", "ymin", "ymax", "zmin",
                 "zmax"):
        assert abs(rows[1][name] / rows[0][name] - 1) <= 5e-7
    assert rows[1]["zmin"] > -57.5
    assert 62 < rows[1]["zmax"] < 63.5
