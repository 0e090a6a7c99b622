# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1
"""Step 2: the errors against the exact solution, and their orders."""
from tests.common.steps import StepTest, overrides, tables


class Step2(StepTest):
    def test_orders(self):
        errors, = tables(self.step())
        self.assertEqual(errors["cells"], [1976, 7860, 31428, 125676])
        # Third order of displacement and gap, second of its gradient. Coarse
        # grids do better than that, so that the mean rate is above it, too.
        rates = errors["displacement rate"][1:]
        self.assertGreater(sum(rates) / len(rates), 3)
        self.assertGreater(min(rates), 2.6)
        self.assertGreater(min(errors["gap rate"][1:]), 2.7)
        self.assertGreater(min(errors["deformation rate"][1:]), 1.85)
        self.assert_near(errors["displacement"],
                         [0.8406, 0.05699, 5.961e-3, 9.171e-4], 0.01)
        self.assert_near(errors["deformation"],
                         [3.385e-2, 5.675e-3, 1.312e-3, 3.511e-4], 0.01)

    def test_few_cells(self):
        """Five cells to a grid spacing are the limit on the finest grid."""
        errors, = tables(self.step(*overrides({"Tissue/Cell spacing": "20"})))
        self.assertLess(errors["displacement rate"][-1], 2.5)

