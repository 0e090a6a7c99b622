# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 6: what the size checkpoint holds, and where."""
from tests.common.steps import StepTest, overrides, read_csv, tables

KEYS = {"Tissue/Cell spacing": "40", "Grid/Spacing": "100",
        "Time/End time": "2.5"}


class Step6(StepTest):
    def test_checkpoint(self):
        whole, layers = tables(self.step(*overrides(KEYS)))
        self.assertEqual(whole["J_th"], [0, 0.8, 0.9])
        self.assertEqual(whole["held"][0], 0)
        self.assertGreater(min(whole["held"][1:]), 10)
        # The larger the threshold, the fewer the cells, and the lower the energy.
        for name in ("cells", "energy", "apex"):
            self.assertEqual(whole[name], sorted(whole[name], reverse=True))
        self.assertGreater(min(whole["smallest J_e"][1:]),
                           whole["smallest J_e"][0])

        self.assertEqual(layers["layer"], [4, 3, 2, 1, 0] * 3)
        founders = [layers["founders"][i:i + 5] for i in (0, 5, 10)]
        self.assertEqual(founders[0], founders[1])
        self.assertEqual(founders[0], founders[2])
        per_founder = [layers["cells per founder"][i:i + 5]
                       for i in (0, 5, 10)]
        for n, cells in zip(per_founder, whole["cells"]):
            self.assertAlmostEqual(
                sum(a * b for a, b in zip(n, founders[0])), cells, delta=1)
        # Without checkpoint all layers are alike; with it, those that are held
        # at their surface divide less, and are less squeezed.
        self.assertLess(max(per_founder[0]) / min(per_founder[0]), 1.15)
        J_e = [layers["J_e"][i:i + 5] for i in (0, 5, 10)]
        for i in (1, 2):
            self.assertLess(per_founder[i][4], 0.9 * per_founder[0][4])
            self.assertGreater(J_e[i][4], J_e[0][4])

        table = read_csv(self.work / "output/layers.csv")
        self.assertEqual(len(table), 15)
        self.assert_near(table["cells_per_founder"],
                         layers["cells per founder"], absolute=1e-4)

