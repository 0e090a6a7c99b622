#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/rounding-drop.prm and spheroid-in-a-mould.prm, on coarser lattices:
a drop rounds up, and tissue in a tube grows along it."""
from program import TESTS, ProgramTest, main, overrides, read_csv

EXAMPLES = TESTS.parent / "prm/examples"


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


if __name__ == "__main__":
    main()
