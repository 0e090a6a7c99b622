# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""An elastic load cycle that does not close exactly: by how much, and that
shorter steps cure it (doc/accuracy-and-cost.md, Load cycles)."""
import numpy
from tests.common.program import ProgramTest, overrides, read_csv

CYCLES = 5

SCENE = """\
set Dimension = 2
subsection Time
  set End time = 5
  set Step     = 0.05
end
subsection Tissue
  set Shape        = box
  set Size         = 200, 100, 1
  set Center       = 0, 50, 0
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 37
  set Offset  = 3, 5
end
subsection Boundary conditions
  set Fixed where  = Y < 1 || Y > 99
  set Displacement = if(Y > 50, 20*sin(2*pi*t), 0); 0
end
subsection Output
  set Interval = 1
  set Formats  = csv
end
""".replace("pi", repr(numpy.pi))


class LoadCycles(ProgramTest):
    def left(self, step):
        """How far from where it began the farthest cell is after the first and
        after the last cycle, µm."""
        output = self.work / f"step-{step}"
        self.execute(self.write("cycle.prm", SCENE),
                     *overrides({"Time/Step": step}), output=output)
        distances = []
        for cycle in (1, CYCLES):
            cells = read_csv(output / f"cells-{cycle:04d}.csv")
            distances.append(numpy.hypot(cells["x"] - cells["X"],
                                         cells["y"] - cells["Y"]).max())
        return distances

    def test_what_is_left_falls_with_the_step(self):
        first, last = self.left(0.05)
        self.assertLess(first, 0.2)  # of a shear of 20 µm either way
        self.assertLess(last, 0.6)
        fine_first, fine_last = self.left(0.0125)
        self.assertLess(fine_first, 0.2)
        # What each further cycle adds is of the first order in the step.
        self.assertLess(fine_last - fine_first, 0.4 * (last - first))

