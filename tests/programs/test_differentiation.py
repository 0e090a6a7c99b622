# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/differentiation.prm, on a coarser lattice: as many cells age as
their rate says, and the same ones on two ranks."""
import csv
import math

from tests.common.program import TESTS, ProgramTest, overrides

SCENE = TESTS.parent / "prm/examples/differentiation.prm"
COARSER = overrides({"Tissue/Cell spacing": "10", "Grid/Spacing": "40",
                     "Output/Formats": "none"})
END = 1.8
PROGENITOR = "0"


def rows(file):
    with open(file, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def hazard(age):
    """The integral of 1.5*hill(age, 1, 8), by the trapezoidal rule."""
    n = 200
    rates = [1.5 * a**8 / (1 + a**8)
             for a in (age * i / n for i in range(n + 1))]
    return age / n * (sum(rates) - (rates[0] + rates[-1]) / 2)


class Differentiation(ProgramTest):
    def test_numbers(self):
        output = self.work / "output"
        self.execute(SCENE, *COARSER, output=output)
        events = rows(output / "events.csv")
        self.assertEqual({e["from"] for e in events}, {"progenitor"})
        self.assertEqual({e["to"] for e in events}, {"aged", "pressed"})

        # How long each cell was a progenitor: until it changed or divided.
        cells = rows(output / "lineage.csv")
        end = {cell["parent"]: float(cell["birth_time"]) for cell in cells}
        end.update({e["id"]: float(e["time"]) for e in events})
        spans = {cell["id"]: end.get(cell["id"], END)
                 - float(cell["birth_time"])
                 for cell in cells if cell["type"] == PROGENITOR}
        # Events less integrated rates are a martingale: their mean is 0, and
        # its variance the sum of the integrated rates.
        expected = sum(hazard(age) for age in spans.values())
        aged = [e for e in events if e["to"] == "aged"]
        self.assertGreater(expected, 150)
        self.assertLess(abs(len(aged) - expected), 3 * math.sqrt(expected))
        # 0.3 day: a chance of 1e-5 for all cells together.
        self.assertGreater(min(spans[e["id"]] for e in aged), 0.3)

    def test_ranks(self):
        """The same cells become the same, one after the other, on two ranks."""
        said = []
        for ranks in (1, 2):
            output = self.work / f"ranks-{ranks}"
            self.execute(SCENE, *COARSER, ranks=ranks, output=output)
            said.append([[[row[name] for name in names]
                          for row in rows(output / file)]
                         for file, names in (
                             ("events.csv", ("id", "event", "from", "to")),
                             ("lineage.csv", ("id", "parent", "type")))])
        self.assertGreater(len(said[0][0]), 300)
        self.assertEqual(said[0], said[1])

