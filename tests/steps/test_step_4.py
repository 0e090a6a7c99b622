# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 4: errors against the reference, at a stretch of 1.1."""
from tests.common.steps import ROOT, StepTest, overrides, read_csv, tables

KEYS = {"Time/End time": "1", "Tissue/Cell spacing": "25"}


class Step4(StepTest):
    def test_errors(self):
        rows, = tables(self.step(*overrides(KEYS)))
        exact = read_csv(ROOT / "doc/data/half-fixed-sphere.csv")[0]
        self.assertEqual(exact["theta"], 1.1)
        self.assertEqual(rows["clamp"], 4 * ["symmetric"] + 4 * ["unsymmetric"])
        self.assertEqual(rows["h"], 2 * [100, 75, 50, 37.5])
        self.assertEqual(rows["unknowns"], sorted(rows["unknowns"][:4]) * 2)
        for result, column, error in (("apex", "apex", "error, %"),
                                      ("energy", "mean_energy_density",
                                       "error, % 2")):
            self.assert_near(rows[error],
                             [100 * (value / exact[column] - 1)
                              for value in rows[result]], absolute=0.05)

        # The symmetric form with the large penalty is the worse one everywhere,
        # and its energy gets better with every refinement.
        energy = rows["error, % 2"]
        for symmetric, unsymmetric in zip(energy[:4], energy[4:]):
            self.assertGreater(symmetric, 3 * abs(unsymmetric))
        self.assertEqual(energy[:4], sorted(energy[:4], reverse=True))
        # 5.6 % with two and a half grid cells to the radius, falling with h
        self.assertLess(max(map(abs, energy[4:])), 6)
        self.assertLess(max(map(abs, energy[6:])), 1)
        self.assertLess(abs(rows["error, %"][-1]), 0.2)
        self.assert_near(rows["energy"], [0.01743, 0.01597, 0.01469, 0.01418,
                                          0.01354, 0.01320, 0.01292, 0.01294],
                         0.01)

    def test_refusals(self):
        message = self.step("-s", "Time/End time=1.5", code=1)
        self.assertIn("1.150000", message)
        self.assertFalse((self.work / "output").exists())

