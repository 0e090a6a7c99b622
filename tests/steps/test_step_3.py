# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 3: free growth is exact, and stresses balance where it is not free."""
import re

from tests.common.steps import StepTest, overrides, tables


def distance(text):
    return float(re.search(r"free growth: (\S+) um", text)[1])


class Step3(StepTest):
    def test_uniform_growth(self):
        text = self.step()
        rows, = tables(text)
        self.assert_near(rows["height"], [200 + 20 * t for t in range(6)],
                         absolute=1e-4)
        self.assert_near(rows["volume/grown"], [1.0] * 6, absolute=1e-6)
        self.assertLess(max(rows["energy"]), 1e-14)
        self.assertLess(max(rows["stress"]), 1e-9)
        self.assertLess(distance(text), 1e-7)

    def test_resume(self):
        self.step(*overrides({"Time/End time": "2"}))
        text = self.step("--resume")
        rows, = tables(text)
        self.assertEqual(rows["day"], [2, 3, 4, 5])
        self.assertLess(distance(text), 1e-7)
        rows, = tables(self.step("--resume"))
        self.assertEqual(rows["day"], [5])

    def test_growing_top(self):
        text = self.step(*overrides(
            {"Growth/Isotropic/Stretch": "1 + 0.1*t*(Z > 100)"}))
        rows, = tables(text)
        self.assertGreater(min(rows["energy"][1:]), 1e-4)
        self.assertGreater(distance(text), 1.0)
        for pressure, stress in zip(rows["pressure"][1:], rows["stress"][1:]):
            # The plane is held up to a small gap.
            self.assertLess(abs(pressure), 1e-4 * stress)

