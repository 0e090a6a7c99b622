# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 1: what the splines reproduce, and their condition numbers."""
import math

from tests.common.steps import StepTest, overrides, tables


class Step1(StepTest):
    def test_errors_and_condition_numbers(self):
        text = self.step(*overrides({"Tissue/Cell spacing": "2"}))
        errors, conditions = tables(text)
        self.assertEqual(errors["unknowns"], [16, 60, 176, 656])
        # Partition of unity and quadratics: rounding errors.
        self.assertLess(max(errors["of 1"] + errors["of xy"]), 1e-12)
        # The third order, on average, and the values.
        wave = errors["of a wave"]
        self.assertGreater(math.log2(wave[0] / wave[-1]) / 3, 3.0)
        self.assert_near(wave, [7.05e-2, 3.23e-3, 5.39e-4, 4.46e-5], 0.01)
        # Cells of 2 um see slivers of that size: without extension the smallest
        # of 16 cuts is unusable, with it no cut matters.
        self.assertEqual(len(conditions["offset"]), 16)
        self.assertGreater(max(conditions["plain"]), 1e9)
        self.assertLess(max(conditions["extended"]), 1e4)
        self.assertLess(max(conditions["extended, scaled"]), 100.0)
        for plain, extended in zip(conditions["plain, scaled"],
                                   conditions["extended, scaled"]):
            self.assertLess(extended, plain)

    def test_refusals(self):
        self.assertIn("2", self.step("-s", "Dimension=3", code=1))
        self.assertIn("--resume", self.step("--resume", code=1))

