# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/rounding-drop.prm and spheroid-in-a-mould.prm, on coarser lattices:
a drop rounds up, and tissue in a tube grows along it. A mould is the same from a
file."""
from tests.common.program import SCENES, TESTS, ProgramTest, overrides, read_csv

EXAMPLES = TESTS.parent / "prm/examples"
MOULD = "Obstacles/mould/"
# A box of 130, 124 and 120 um, about the origin of the file.
BOX = """OFF
8 6 0
-65 -62 -60
65 -62 -60
65 62 -60
-65 62 -60
-65 -62 60
65 -62 60
65 62 60
-65 62 60
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


class DropAndMould(ProgramTest):
    def last_row(self, scene, keys):
        output = self.work / "output"
        self.execute(EXAMPLES / scene, *overrides(
            {"Output/Formats": "none", **keys}), output=output)
        return read_csv(output / "statistics.csv")[-1]

    def test_a_drop_rounds_up(self):
        row = self.last_row("rounding-drop.prm", {
            "Tissue/Cell spacing": "15", "Grid/Spacing": "50",
            "Time/End time": "1"})
        length, width, height = (row[f"{axis}max"] - row[f"{axis}min"]
                                 for axis in "xyz")
        self.assertLess(length / width, 1.25)  # 2 at first
        self.assertGreater(length / width, 1)
        self.assertAlmostEqual(width / height, 1, delta=0.02)

    def test_a_spheroid_fills_a_tube(self):
        row = self.last_row("spheroid-in-a-mould.prm", {"Time/End time": "2.5"})
        for axis in "xy":
            self.assertLess(row[f"{axis}max"], 63.5)
            self.assertGreater(row[f"{axis}min"], -63.5)
            self.assertGreater(row[f"{axis}max"], 62)
        self.assertGreater(row["zmax"] - row["zmin"], 170)

    def test_a_mould_from_a_file(self):
        """The ball of the scene mould grows in a box, which a file describes, too.
        A place and a step with which no step fails: the ball is free to slide, and
        steps that are halved would end elsewhere."""
        rows = []
        for keys in ({MOULD + "Shape": "box", MOULD + "Size": "130, 124, 120"},
                     {MOULD + "Shape": "mesh",
                      MOULD + "Surface mesh": self.write("box.off", BOX)}):
            self.execute(SCENES / "mould.prm", "--replace", *overrides(
                {"Tissue/Cell spacing": "12", "Grid/Spacing": "30",
                 "Grid/Offset": "14, 1, 9", "Time/Step": "0.05",
                 "Time/End time": "0.5", "Output/Formats": "none",
                 MOULD + "Center": "1, 2, 3", **keys}))
            statistics = read_csv(self.work / "output/statistics.csv")
            self.assertEqual(statistics["rejected_steps"].sum(), 0)
            rows.append(statistics[-1])
        for name in ("total_volume", "mean_energy_density", "xmin", "xmax", "ymin",
                     "ymax", "zmin", "zmax"):
            self.assertAlmostEqual(rows[1][name] / rows[0][name], 1, places=6)
        self.assertGreater(rows[1]["zmin"], -57.5)
        self.assertGreater(rows[1]["zmax"], 62)
        self.assertLess(rows[1]["zmax"], 63.5)

