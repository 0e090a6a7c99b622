# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue whose cells divide and die, with a surface that is made anew:
doc/theory.md, sections 4.5 and 6.9.
"""
import numpy as np
from morula.run import Run
from tests.common.program import TESTS, ProgramTest, overrides, without_wall_time

EXAMPLE = TESTS.parent / "prm/examples/turnover.prm"
# In the plane, with a few hundred cells. The outline is a random walk: with many
# seeds pieces of it lose the cells for some days. With this one they do not.
DISC = {"Dimension": 2, "Tissue/Radius": 150, "Output/Formats": "csv",
        "Random seed": 4}
SPACING = 12.5  # L_p, um


class Turnover(ProgramTest):
    def run_disc(self, keys, *arguments, name="output", **more):
        output = self.work / name
        self.execute(EXAMPLE, *overrides({**DISC, **keys}), *arguments,
                     output=output, **more)
        return output

    def check_surface(self, surface, cells):
        """It is closed, encloses the cells, has about as many patches as the
        first one on its length, and is round."""
        x, n = surface[["x", "y"]], surface[["nx", "ny"]].to_numpy()
        area = surface["area"].to_numpy()
        volume = cells["volume"].sum()
        self.assertLess(np.linalg.norm(area @ n), 0.01 * area.sum())
        enclosed = (area[:, None] * n * x.to_numpy()).sum() / 2
        self.assertAlmostEqual(enclosed / volume, 1, delta=0.03)
        patches = len(area) * SPACING / area.sum()
        self.assertGreater(patches, 0.5)
        self.assertLess(patches, 2)
        self.assertLess(area.sum() / np.sqrt(4 * np.pi * volume), 1.5)
        return area.sum()

    def test_ten_days(self):
        """As many cells die as are born in the mean. Nothing regulates their
        number: its standard deviation is that of the critical age-dependent
        branching process, sqrt(0.707 N t/day), 2.5 times sqrt(N) here."""
        run = Run(self.run_disc({"Output/Interval": 2}))
        table = run.statistics
        begin, last = table[table["time"] > 1].iloc[0], table.iloc[-1]
        self.assertGreater(table["deaths"].sum(), 4 * begin["cells"])
        self.assertLess(abs(last["cells"] - begin["cells"]),
                        3 * np.sqrt(0.707 * begin["cells"] * 9))
        # a cell is as large as it was
        size = table["total_volume"] / table["cells"]
        self.assertLess(abs(size.iloc[-30:].mean() / size[10:40].mean() - 1),
                        0.02)
        pressed = 1 - table["total_volume"] / table["grown_volume"]
        self.assertLess(abs(pressed).max(), 0.02)
        self.assertEqual({*table["pieces"]}, {1})
        for number in range(1, 6):
            self.check_surface(run.surface(number), run.cells(number))

    def test_ranks_and_resume(self):
        keys = {"Time/End time": 2, "Output/Interval": 1, "Time/Step": 0.125}
        whole = self.run_disc(keys, name="whole")
        self.run_disc({**keys, "Time/End time": 1}, name="parts")
        self.run_disc(keys, "--resume", name="parts")
        for name in ("cells-0002.csv", "surface-0002.csv", "events.csv"):
            self.assert_same_file(whole / name, self.work / "parts" / name)
        self.assertEqual(without_wall_time(whole),
                         without_wall_time(self.work / "parts"))
        two = self.run_disc(keys, name="two", ranks=2)
        one, other = (Run(run).surface(-1) for run in (whole, two))
        self.assertEqual(len(one), len(other))
        np.testing.assert_allclose(one["area"].sum(), other["area"].sum(),
                                   rtol=1e-6)
        self.assertEqual({*Run(whole).cells(-1)["id"]},
                         {*Run(two).cells(-1)["id"]})

