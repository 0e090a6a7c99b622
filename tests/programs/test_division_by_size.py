# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that divide by size: the same on any number of ranks and after a
resumption, of their size, and without the warning of cells that are too long."""
import csv

import numpy

from tests.common.program import TESTS, ProgramTest, overrides, without_wall_time

SCENE = TESTS.parent / "prm/examples/elongating-axis.prm"
SHORT = overrides({"Time/End time": "1.2", "Time/Step": "0.1",
                   "Output/Formats": "csv", "Output/Interval": "0"})
TOO_LONG = "fewer than 2 cells fill Grid/Spacing"

# A plate in 3-D, clamped below, whose upper half grows within its plane.
PLATE = """
subsection Time
  set End time = 1
  set Step     = 0.25
end
subsection Tissue
  set Shape        = box
  set Size         = 60, 60, 30
  set Cell spacing = 10
end
subsection Grid
  set Spacing         = 30
  set Points per cell = 2
end
subsection Material
  set Energy per      = grown volume
  set Relaxation time = 0.1
end
subsection Growth
  set Law = rate
  subsection Rate
    set Rate        = normal(1, 0.1)
    set Share along = 0
    set Direction   = 0; 0; 1
  end
end
subsection Division by size
  set Volume = 1440
  set Noise  = 0.1
end
"""


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def births(output):
    return [(row["id"], row["parent"], row["generation"], row["birth_time"])
            for row in rows(output / "lineage.csv")]


class DivisionBySize(ProgramTest):
    def same_on_ranks(self, scene, *arguments):
        outputs = []
        for ranks in (1, 2, 3):
            outputs.append(self.work / f"{scene.stem}-{ranks}")
            self.execute(scene, *arguments, ranks=ranks, output=outputs[-1])
        self.assertGreater(len(births(outputs[0])),
                           2 * int(rows(outputs[0] / "statistics.csv")[0]["cells"]))
        for output in outputs[1:]:
            self.assertEqual(births(outputs[0]), births(output))
        return outputs[0]

    def test_ranks(self):
        self.same_on_ranks(SCENE, *SHORT)

    def test_ranks_in_3d(self):
        self.write("plate.prm", PLATE)
        output = self.same_on_ranks(self.work / "plate.prm")
        self.assertNotIn(TOO_LONG, (output / "log.txt").read_text())

    def test_resumed(self):
        whole, resumed = self.work / "whole", self.work / "resumed"
        step = overrides({"Time/Step": "0.125", "Time/End time": "1.25"})
        self.execute(SCENE, *SHORT, *step, output=whole)
        self.execute(SCENE, *SHORT, *step, "-s", "Time/End time=0.75",
                     output=resumed)
        self.execute(SCENE, *SHORT, *step, "--resume", output=resumed)
        self.assertEqual(without_wall_time(whole), without_wall_time(resumed))
        self.assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")

    def test_cells_keep_their_size(self):
        output = self.work / "output"
        self.execute(SCENE, *SHORT, output=output)
        self.assertNotIn(TOO_LONG, (output / "log.txt").read_text())
        last = rows(output / "statistics.csv")[-1]
        # Columns of cells, 8 um wide, grow along the axis.
        ramp = numpy.clip((numpy.arange(4, 200, 8) - 100) / 40, 0, 1)
        volume = 96 * 8 * numpy.exp(1.2 * 1.2 * ramp).sum()
        self.assertAlmostEqual(float(last["total_volume"]) / volume, 1, delta=0.02)
        # Each cell has between a half and the whole of a noisy 128 um^2.
        volumes = numpy.array([float(row["volume"]) for row in
                               rows(sorted(output.glob("cells-*.csv"))[-1])])
        self.assertGreater(volumes.min(), 0.5 * 128 * 0.65)
        self.assertLess(volumes.max(), 128 * 1.4)
        self.assertGreater(float(last["min_cells_per_spacing"]), 2)

    def test_without_it_cells_get_long(self):
        output = self.work / "output"
        self.execute(SCENE, *SHORT, *overrides({
            "Division by size/Volume": "0", "Division by size/Noise": "0"}),
                     output=output)
        log = (output / "log.txt").read_text()
        self.assertIn(TOO_LONG, log)
        self.assertIn("Division by size/Volume", log)

    def test_what_is_expected(self):
        text = self.execute(SCENE, "--explain").stdout
        self.assertIn("volume = 128", text)
        self.assertIn("axis = cell shape", text)
        output = self.work / "output"
        self.execute(SCENE, output=output)
        last = int(rows(output / "statistics.csv")[-1]["cells"])
        expected = float(text.split("cells at the end: about ")[1].split()[0])
        self.assertAlmostEqual(expected / last, 1, delta=0.1)

