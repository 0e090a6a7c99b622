# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/homeostasis.prm, crypt.prm and branching.prm: the height at which births
and extrusion balance, from below and from above, with a tissue that stays between its
walls; the flux through a crypt; branches where an inhibitor is low."""
import numpy
from tests.common.program import TESTS, ProgramTest, overrides, read_csv

EXAMPLES = TESTS.parent / "prm/examples"


class WalledTissue(ProgramTest):
    def run_scene(self, name, output, **keys):
        output = self.work / output
        self.execute(EXAMPLES / f"{name}.prm", *overrides(
            {"Output/Formats": "csv", **keys}), output=output)
        return output

    def check_height(self, name, start, **keys):
        """H = H* + (H(0) - H*) exp(-k t), H* = 20 um + w (1 + b/k). Some 700 cells
        can be extruded: H has a standard deviation of 2 %."""
        output = self.run_scene("homeostasis", name, **{"Time/End time": 6, **keys})
        table = read_csv(output / "statistics.csv")
        law = 212 + (start - 212) * numpy.exp(-0.5 * table["time"])
        height = table["total_volume"] / 100
        numpy.testing.assert_allclose(height, law, rtol=0.06)
        self.assertAlmostEqual((height / law)[table["time"] > 1].mean(), 1,
                               delta=0.03)
        self.assertGreater(table["removed"].sum(), 800)
        for number in range(7):
            cells = read_csv(output / f"cells-{number:04d}.csv")
            self.assertLess(abs(cells["x"]).max(), 50)
            surface = read_csv(output / f"surface-{number:04d}.csv")
            walls = surface[surface["condition"] == 2]
            self.assertGreater(len(walls), 40)
            # what the solver allows, a quarter of a grid spacing
            self.assertLess(abs(abs(walls["x"]) - 50).max(), 12.5 / 4)
            numpy.testing.assert_allclose(abs(walls["X"]), 50, atol=1e-9)

    def test_height_from_below(self):
        self.check_height("below", 120)

    def test_height_from_above(self):
        self.check_height("above", 280, **{"Tissue/Center": "0, 140",
                                           "Tissue/Size": "100, 280"})

    def test_crypt(self):
        """What grows in 80 um at 0.7 a day goes up and out: 56 um a day, within two
        standard deviations of some 700 cells."""
        output = self.run_scene("crypt", "crypt")
        table = read_csv(output / "statistics.csv")
        late = table[table["time"] > 3]
        size = (late["grown_volume"] / late["cells"]).mean()
        flux = late["removed"].sum() * size / 80 / 3
        self.assertAlmostEqual(flux / 56, 1, delta=0.075)
        height = table["total_volume"] / 80
        self.assertLess(abs(height - 225).max(), 10)
        last = read_csv(output / "cells-0012.csv")
        self.assertLess(abs(last["x"]).max(), 40)
        error = last["signal"] - numpy.exp(-last["y"] / 60)
        self.assertLess(numpy.sqrt((error**2).mean()), 0.02)

    def test_branches(self):
        """The corners of the bud run ahead of its sides."""
        output = self.run_scene("branching", "branching",
                                **{"Time/End time": 1.5})
        ratios = []
        for number in (0, 3):
            cells = read_csv(output / f"cells-{number:04d}.csv")
            radius = numpy.hypot(cells["x"], cells["y"])
            angle = numpy.arctan2(cells["y"], cells["x"]) / (numpy.pi / 4)
            near = numpy.rint(angle).astype(int)
            across = abs(angle - near) < 0.2
            ratios.append(radius[across & (near % 2 == 1)].max() /
                          radius[across & (near % 2 == 0)].max())
        self.assertLess(ratios[0], 1.45)
        self.assertGreater(ratios[1], 2)

