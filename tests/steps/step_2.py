#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 2: the errors against the exact solution, and their orders."""
from steps import StepTest, main, overrides, tables


class Step2(StepTest):
    def test_orders(self):
        errors, = tables(self.step())
        self.assertEqual(errors["cells"], [1976, 7860, 31428, 125676])
        # Third order of displacement and gap, second of its gradient.
        self.assertGreater(min(errors["displacement rate"][1:]), 2.8)
        self.assertGreater(min(errors["gap rate"][1:]), 2.7)
        self.assertGreater(min(errors["deformation rate"][1:]), 1.9)
        self.assert_near(errors["displacement"],
                         [1.245, 0.1084, 7.558e-3, 9.889e-4], 0.01)
        self.assert_near(errors["deformation"],
                         [3.841e-2, 7.573e-3, 1.417e-3, 3.563e-4], 0.01)

    def test_few_cells(self):
        """Five cells to a grid spacing are the limit on the finest grid."""
        errors, = tables(self.step(*overrides({"Tissue/Cell spacing": "20"})))
        self.assertLess(errors["displacement rate"][-1], 2.5)


if __name__ == "__main__":
    main()
