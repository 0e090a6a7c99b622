# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""doc/glossary.md has every column and every section of timings."""
import csv
import re

from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent

# Every effect, on a tissue of some cells.
SCENE = """
include {cube}
set Output directory = {output}
subsection Time
  set End time = 0.125
end
subsection Tissue
  set Refine surface = true
end
subsection Boundary conditions
  set Traction where = X > 29
  set Traction       = 0.001; 0; 0
  set Pressure where = Z > 59
  set Pressure       = 0.001
  set Surface tension = 0.001
end
subsection Obstacles
  set Names = floor
  subsection floor
    set Shape  = plane
    set Center = 0, 0, -70
    set Normal = 0, 0, 1
  end
end
subsection Body force
  set Force density = 0; 0; -1e-6
end
subsection Output
  set Formats            = csv, vtu
  set Condition estimate = true
end
"""


def words():
    """What stands in the first columns of the glossary's tables."""
    text = (ROOT / "doc/glossary.md").read_text(encoding="utf-8")
    return {word for row in re.findall(r"^\| (`.*?) \|", text, flags=re.M)
            for word in re.findall(r"`([^`]+)`", row)}


class Glossary(ProgramTest):
    def test_outputs(self):
        output = self.work / "output"
        scene = self.write("all.prm", SCENE.format(
            cube=TESTS / "programs/small-cube.prm", output=output))
        self.execute(scene, output=output)
        columns, sections = set(), set()
        for file in output.glob("*.csv"):
            with open(file, newline="") as table:
                rows = csv.DictReader(table)
                columns |= set(rows.fieldnames)
                if file.name == "timings.csv":
                    sections = {row["section"] for row in rows}
        for file in output.glob("*.vtu"):
            columns |= set(re.findall(rb'Name="([^"]+)"', file.read_bytes()))
        columns = {c.decode() if isinstance(c, bytes) else c for c in columns}
        self.assertGreater(len(columns), 60)
        self.assertGreater(len(sections), 15)
        known = words()
        vtk = {"connectivity", "offsets", "types", "Points", "TIME", "CYCLE"}
        self.assertEqual(sorted(columns - known - vtk), [])
        self.assertEqual(sorted(sections - known - {"total"}), [])

