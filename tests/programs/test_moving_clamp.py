# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A clamp that moves by many grid spacings in one step takes the tissue with it,
whatever else the step does: nothing but the place is another.
"""
from tests.common.program import ProgramTest, overrides, read_csv

SPACING = 25.0
SCENE = f"""
set Dimension = 2
subsection Time
  set End time = 1
  set Step     = 0.5
end
subsection Tissue
  set Radius       = 80
  set Cell spacing = 8
end
subsection Grid
  set Spacing = {SPACING}
end
subsection Growth
  set Law = isotropic
  subsection Isotropic
    set Stretch = 1 + 0.2*t*(1 + X/200)
  end
end
subsection Boundary conditions
  set Fixed where     = Y < 0
  set Nitsche penalty = 1000
end
subsection Solver
  set Newton tolerance = 1e-10
end
subsection Output
  set Formats  = csv
  set Interval = 0
end
"""


class MovingClamp(ProgramTest):
    def run_scene(self, name, form, keys, ranks=1):
        output = self.work / name
        scene = self.write("scene.prm", SCENE)
        self.execute(scene, *overrides(
            {"Boundary conditions/Nitsche form": form, **keys}),
            output=output, ranks=ranks)
        rows = read_csv(output / "statistics.csv")
        self.assertEqual(rows["rejected_steps"].sum(), 0)
        return rows, read_csv(output / "cells-0001.csv")

    def compare(self, form, ranks):
        """20 spacings in the first step, 7 back in the second: by whole
        spacings, so that the grid lies in the tissue as it did."""
        rows, cells = self.run_scene("rest", form, {})
        moving, moved = self.run_scene(
            "moving", form,
            {"Boundary conditions/Displacement":
             f"if(t < 0.75, {20 * SPACING}, {13 * SPACING}); "
             f"if(t < 0.75, {-6 * SPACING}, {2 * SPACING}); 0"}, ranks)
        self.assertLess(abs(moved["x"] - cells["x"] - 13 * SPACING).max(),
                        1e-6)
        self.assertLess(abs(moved["y"] - cells["y"] - 2 * SPACING).max(), 1e-6)
        self.assertLess(abs(moved["energy_density"]
                            - cells["energy_density"]).max(), 1e-7)
        # ... and as easily.
        self.assertLessEqual(moving["newton_iterations"].sum(),
                             rows["newton_iterations"].sum() + 2)

    def test_symmetric(self):
        self.compare("symmetric", 1)

    def test_unsymmetric_on_two_ranks(self):
        self.compare("unsymmetric", 2)

    def test_clamps_torn_apart(self):
        """No rigid motion: the message says what is asked for."""
        result = self.execute(
            self.write("scene.prm", SCENE), *overrides(
                {"Boundary conditions/Fixed where": "(Y < -40) || (Y > 40)",
                 "Boundary conditions/Nitsche form": "symmetric",
                 "Boundary conditions/Displacement":
                 f"0; if(Y > 0, {6 * SPACING}, 0); 0",
                 "Time/Smallest step": "0.1"}), code=2)
        self.assertIn(f"held points move by {6 * SPACING:g} um: let Boundary "
                      "conditions/Displacement rise from 0 with t.",
                      result.stdout + result.stderr)

    def test_at_rest_nothing_changes(self):
        """A displacement that is constant in time is no motion after the first
        step."""
        rows, cells = self.run_scene("one", "symmetric", {})
        _, other = self.run_scene(
            "two", "symmetric", {"Boundary conditions/Displacement":
                                 "0*t; 0; 0"})
        self.assertEqual(cells.tobytes(), other.tobytes())
        self.assertEqual(len(rows), 3)

