# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fields that come in at fixed values, wherever the grid lines lie: what is in
a slab is l tanh(L/l)/L of the value, l the root of diffusion over uptake."""
import math

from morula.execute import overrides
from morula.run import Run
from tests.common.program import ProgramTest

H, LENGTH = 20, 160
OFFSETS = (0, 5, 10, 15)


class FieldLayers(ProgramTest):
    def ratio(self, reach, offset, dim=2, cell=5, ranks=1):
        """What is in the slab to what shall be, and what is said."""
        keys = {"Dimension": dim, "Tissue/Shape": "box",
                "Tissue/Size": f"{LENGTH}, 40, 20", "Tissue/Cell spacing": cell,
                "Grid/Spacing": H, "Grid/Offset": f"{offset}, 3, 7",
                "Time/End time": 0.1, "Time/Step": 0.1,
                "Output/Formats": "none", "Fields/Names": "u",
                "Fields/u/Diffusion": 1000,
                "Fields/u/Consumption": 1000 / (reach * H)**2,
                "Fields/u/Fixed where": "X > 79.9", "Fields/u/Value": 1}
        if dim == 2:
            keys["Tissue/Size"] = f"{LENGTH}, 40"
            keys["Grid/Offset"] = f"{offset}, 3"
        name = f"{dim}-{reach}-{offset}-{ranks}"
        result = self.execute(self.write(f"{name}.prm", ""), *overrides(keys),
                              ranks=ranks, output=self.work / name)
        mean = Run(self.work / name).statistics["u_mean"].iloc[-1]
        layer = reach * H
        return mean / (layer / LENGTH * math.tanh(LENGTH / layer)), result.text

    def test_layers_that_the_grid_resolves(self):
        for dim, reach, allowed in ((2, 0.5, 0.03), (2, 1, 0.01), (2, 2, 0.003),
                                    (2, 5, 0.001), (3, 1, 0.01)):
            for number, offset in enumerate(OFFSETS):
                ratio, said = self.ratio(reach, offset, dim,
                                         ranks=1 + number % 2)
                self.assertAlmostEqual(ratio, 1, delta=allowed,
                                       msg=f"{dim}-D, {reach} h, {offset}")
                self.assertNotIn("the field reaches only", said)

    def test_layers_that_it_does_not_resolve(self):
        """The word names the error at the worst offset."""
        for reach in (0.15, 0.22, 0.35, 0.45):
            ratios = []
            for offset in (*OFFSETS, 2.5):
                ratio, said = self.ratio(reach, offset, cell=2.5)
                ratios.append(ratio)
                may_be = float(said.split("may be too much by ")[1].split()[0])
                self.assertIn("less than half a grid spacing", said)
            self.assertLess(max(ratios), 1.005 + may_be / 100)
            self.assertGreater(max(ratios), 1 + 0.8 * may_be / 100)
            self.assertGreater(min(ratios), 0.98)

