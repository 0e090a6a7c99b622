# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/folding-by-contraction.prm with weak contraction: each hinge turns
the sheet by the angle of doc/theory.md (9.2)."""
import csv
import math

from tests.common.program import TESTS, ProgramTest, overrides

SCENE = TESTS.parent / "prm/examples/folding-by-contraction.prm"
CONTRACTION, ZONE, THICKNESS = 0.02, 120.0, 40.0


def slope_of(cells, low, high):
    """Angle to the x axis of those cells that began between low and high."""
    chosen = [(float(c["X"]), float(c["Y"]), float(c["x"]), float(c["y"]))
              for c in cells if low < float(c["X"]) < high]
    # The rotation that fits best, of two point sets with the same centre.
    means = [sum(column) / len(chosen) for column in zip(*chosen)]
    sine = cosine = 0.0
    for row in chosen:
        X, Y, x, y = (value - mean for value, mean in zip(row, means))
        cosine += X * x + Y * y
        sine += X * y - Y * x
    return math.atan2(sine, cosine)


class FoldingByContraction(ProgramTest):
    def test_angles(self):
        output = self.work / "output"
        self.execute(SCENE, *overrides({
            "Contraction/Stretch":
                f"1 - {CONTRACTION}*t*if(Y > 0, abs(X) < 60, "
                "abs(abs(X) - 180) < 60)",
            "Output/Interval": "1", "Output/Formats": "csv"}), output=output)
        with open(output / "cells-0001.csv", encoding="utf-8") as file:
            cells = list(csv.DictReader(file))
        flanks = [slope_of(cells, low, low + 40)
                  for low in (-290, -110, 70, 250)]
        hinges = [after - before for before, after in zip(flanks, flanks[1:])]
        expected = 1.5 * CONTRACTION * ZONE / THICKNESS
        for hinge, sign in zip(hinges, (-1, 1, -1)):
            self.assertAlmostEqual(sign * hinge / expected, 1.0, delta=0.01)
        self.assertAlmostEqual(flanks[0], -flanks[3], delta=1e-6)

