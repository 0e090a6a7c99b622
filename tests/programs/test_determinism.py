# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The same tissue on 1, 2 and 3 ranks, on larger scenes than the references:
several grid cells a rank, with cells that move from rank to rank.
"""
from tests.common.program import SCENES, ProgramTest, overrides, read_csv

PAPER = SCENES.parents[1] / "prm/paper"
NEAR = {"x": 1e-6, "y": 1e-6, "z": 1e-6}


class Determinism(ProgramTest):
    def run_on_all(self, scene, keys):
        keys = {"Output/Formats": "csv", "Output/Interval": "0", **keys}
        for ranks in (1, 2, 3):
            output = self.work / f"{ranks}"
            self.execute(scene, *overrides(keys), ranks=ranks, output=output)
            for name in ("lineage.csv", "cells-0001.csv", "surface-0001.csv"):
                first = self.work / "1" / name
                if name == "cells-0001.csv":
                    columns = read_csv(first).dtype.names
                    near = {c: 1e-6 for c in columns[11:]}
                    near["volume"] = 1e-4
                elif name == "surface-0001.csv":
                    near = {"nx": 1e-6, "ny": 1e-6, "nz": 1e-6, "area": 1e-4,
                            # kPa um^2, on patches of some 100 um^2
                            **{f"force_{d}": 1e-4 for d in "xyz"}}
                else:
                    near = {}
                with self.subTest(file=name, ranks=ranks):
                    self.assert_same_columns(first, output / name,
                                             {**near, **NEAR})
        lineage = read_csv(self.work / "1/lineage.csv")
        self.assertGreater((lineage["parent"] >= 0).sum(), 100)

    def test_cube(self):
        """Fig. 3b with coarser cells, one day."""
        self.run_on_all(PAPER / "fig-3b.prm",
                        {"Time/End time": "1", "Time/Step": "0.2",
                         "Tissue/Cell spacing": "20",
                         "Tissue/Boundary points": "600",
                         "Solver/Newton tolerance": "1e-10"})

    def test_refined_surface(self):
        """The surface's points are split in mid-run, some of them held."""
        self.run_on_all(SCENES.parent / "programs/small-cube.prm",
                        {"Tissue/Refine surface": "true",
                         "Tissue/Boundary points": "96", "Grid/Spacing": "32",
                         "Solver/Newton tolerance": "1e-10"})
        surface = read_csv(self.work / "1/surface-0001.csv")
        self.assertGreater(len(surface), 96)
        self.assertGreater((surface["condition"] == 2).sum(), 16)

    SPHERE = {"Tissue/Radius": "60", "Tissue/Cell spacing": "10",
              "Tissue/Boundary points": "0", "Time/End time": "1",
              "Time/Step": "0.2", "Grid/Spacing": "30",
              "Proliferation/Cell cycle/G0 exit rate": "2"}

    def test_half_fixed_sphere(self):
        self.run_on_all(PAPER / "fig-4c.prm",
                        {**self.SPHERE, "Solver/Newton tolerance": "1e-10"})

    def test_half_fixed_sphere_with_checkpoint(self):
        """The checkpoint compares J_e with a threshold: equal decisions need
        tight solves. Until the first daughters wait, nothing is held."""
        self.run_on_all(PAPER / "fig-4b.prm",
                        {**self.SPHERE,
                         "Time/End time": "1.5", "Time/Step": "0.25",
                         "Proliferation/Cell cycle/Size checkpoint": "0.95",
                         "Solver/Newton tolerance": "1e-12"})
        held = read_csv(self.work / "1/statistics.csv")["held_at_checkpoint"]
        self.assertGreater(held.max(), 0)

    def test_seed(self):
        """Another seed gives another tissue, the same one the same bytes."""
        small = SCENES.parent / "programs/small-cube.prm"
        for name, seed in (("a", 4), ("b", 4), ("c", 5)):
            self.execute(small, *overrides({"Random seed": seed}),
                         output=self.work / name)
        self.assert_same_file(self.work / "a/lineage.csv",
                              self.work / "b/lineage.csv")
        self.assertNotEqual((self.work / "a/lineage.csv").read_bytes(),
                            (self.work / "c/lineage.csv").read_bytes())

