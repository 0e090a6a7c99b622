# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1
"""Step 5: the doubled cube, and the expected number of divisions."""
import math
import re

from tests.common.steps import StepTest, overrides, tables

KEYS = {"Tissue/Cell spacing": "20", "Tissue/Boundary points": "0"}


class Step5(StepTest):
    def test_divisions(self):
        text = self.step(*overrides(KEYS))
        together, random = tables(text)
        self.assertEqual(together["cells"], [1000, 1000, 2000, 2000, 2000])
        self.assert_near(together["height"], [200, 290, 300, 310, 400],
                         absolute=1e-6)
        self.assertLess(max(together["energy"]), 1e-14)
        self.assertLess(
            float(re.search(r"error of the height: (\S+) um", text)[1]), 1e-8)

        self.assertEqual(random["seed"], [1, 2, 3])
        p = 1 - math.exp(-1)
        deviation = math.sqrt(1000 * p * (1 - p))
        for i in range(3):
            n = random["divisions"][i]
            self.assertEqual(random["cells"][i], 1000 + n)
            self.assertLess(abs(n - 1000 * p), 4 * deviation)
            self.assertAlmostEqual(random["deviations"][i],
                                   (n - 1000 * p) / deviation, delta=0.01)
            # The variance of n_z^2 is 4/45; some 1,000 cells cycle.
            self.assertAlmostEqual(random["n_z^2"][i], 1 / 3, delta=0.05)
        self.assertGreater(len(set(random["divisions"])), 1)

    def test_refusals(self):
        message = self.step("-s", "Time/End time=2", code=1)
        self.assertIn("Time/End time", message)

