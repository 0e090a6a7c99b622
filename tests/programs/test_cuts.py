# ranks: 3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cuts of no width: their faces press on each other and open."""
import re

import numpy as np

from morula.run import Run
from tests.common.program import ProgramTest, overrides, read_csv

SCENE = """
set Dimension = {dim}
subsection Time
  set End time = 0.4
  set Step     = 0.1
end
subsection Tissue
  set Shape        = box
  set Center       = 30, 30, 10
  set Size         = 60, 60, 20
  set Cell spacing = 2.5
  set Cuts         = {cuts}
end
subsection Grid
  set Spacing = 10
  set Offset  = 3, 7, 0
end
subsection Contact
  set Between = all
end
subsection Boundary conditions
  set Slip where   = Y < 0.001{sides}
  set Fixed where  = Y > 59.999
  set Displacement = 0; 10*t{still}
end
subsection Material
  set Young's modulus = 1
  set Poisson's ratio = 0.4
end
subsection Output
  set Formats  = csv
  set Interval = 0.1
end
"""

LINE = "LINESTRING(-20 30, 30 30)\n"
# The same cut as a surface, which ends outside of the tissue.
PLANE = ("OFF\n4 1 0\n-20 30 -5\n30 30 -5\n30 30 25\n-20 30 25\n"
         "4 0 1 2 3\n")


class Cuts(ProgramTest):
    def scene(self, dim=2, cuts=None):
        cuts = cuts if cuts is not None else LINE if dim == 2 else PLANE
        name = "cut.wkt" if dim == 2 else "cut.off"
        self.write(name, cuts)
        return self.write("scene.prm", SCENE.format(
            dim=dim, cuts=name if cuts else "",
            sides=" || Z < 0.001 || Z > 19.999" if dim == 3 else "",
            still="; 0" if dim == 3 else ""))

    def force(self, scene, way, ranks=1, **keys):
        still = "; 0" if "Dimension = 3" in scene.read_text() else ""
        self.execute(scene, "--replace", *overrides({
            "Boundary conditions/Displacement": f"0; {way}*t{still}", **keys}),
            ranks=ranks)
        forces = Run(self.work / "output").forces
        return forces[forces["name"] == "fixed"].iloc[-1]["force_y"]

    def opening(self):
        """How far the faces are apart at the mouth of the cut, um."""
        points = read_csv(self.work / "output/surface-0004.csv")
        mouth = points[(abs(points["Y"] - 30) < 1e-6) & (points["X"] < 4)]
        upper = mouth["ny"] < 0
        return mouth["y"][upper].mean() - mouth["y"][~upper].mean()

    def test_a_cut_carries_pressure_and_no_tension(self):
        """as a slit does: under pressure the block is as without it."""
        whole, cut = self.scene(cuts=""), LINE
        pressed = self.force(whole, -10)
        drawn = self.force(whole, 10)
        scene = self.scene(cuts=cut)
        self.assertAlmostEqual(self.force(scene, -10) / pressed, 1, delta=3e-3)
        self.assertLess(abs(self.opening()), 0.05)
        self.assertLess(self.force(scene, 10), 0.9 * drawn)
        self.assertGreater(self.opening(), 2.5)

    def test_in_3d_as_in_2d(self):
        """A block that cannot give way along z, on any ranks. The end of the cut
        is seen to within a grid spacing."""
        pressed = self.force(self.scene(), -10)
        self.assertAlmostEqual(
            self.force(self.scene(dim=3), -10) / (20 * pressed), 1, delta=5e-3)
        self.assertLess(abs(self.opening()), 0.05)
        whole = self.force(self.scene(cuts=""), 10)
        self.force(self.scene(), 10)
        opening = self.opening()
        self.assertLess(self.force(self.scene(dim=3), 10, ranks=3),
                        0.9 * 20 * whole)
        self.assertAlmostEqual(self.opening() / opening, 1, delta=0.1)

    def test_any_ranks_give_the_same(self):
        scene, found = self.scene(), []
        for ranks in (1, 3):
            self.force(scene, 10, ranks)
            points = read_csv(self.work / "output/surface-0004.csv")
            found.append(points[np.argsort(points["id"])])
        for name in ("id", "X", "Y"):
            self.assertTrue(np.array_equal(found[0][name], found[1][name]), name)
        for name in ("x", "y", "nx", "ny"):
            self.assertLess(np.max(abs(found[0][name] - found[1][name])), 1e-5)

    def test_what_is_said(self):
        explained = self.execute(self.scene(), "--explain").text
        self.assertRegex(explained, r"cuts +on +30 um in 12 patches on each side")

    def test_far_ends_are_left_out(self):
        explained = self.execute(
            self.scene(cuts="LINESTRING(-1e9 30, 1e9 30)"), "--explain").text
        found = re.search(r"cuts +on +([0-9.]+) um in (\d+) patches", explained)
        # The piece at each end is halved three times.
        self.assertAlmostEqual(float(found[1]), 60, delta=2.5 / 4)
        self.assertLess(int(found[2]), 40)

    def test_what_is_refused(self):
        for cuts, keys, message in (
                (LINE, {"Contact/Between": "none"},
                 "Tissue/Cuts = '.*cut.wkt': allowed is nothing, as "
                 "Contact/Between = none"),
                ("LINESTRING(70 0, 70 60)", {}, "no place on them that has cells"),
                ("LINESTRING(0 31.25, 30 31.25)", {}, "cells have their middle"),
                ("LINE(0 30, 30 30)", {}, "LINESTRING or MULTILINESTRING"),
                ("LINESTRING(0 30, nan 30)", {}, "there is no number"),
                ("LINESTRING(0 30 0, 30 30 0)", {}, "are not two coordinates"),
                ("LINESTRING(0 30, inf 30)", {}, "there is no number"),
                (PLANE, {"Tissue/Cuts": "surface.off"}, "ends with .wkt")):
            with self.subTest(message):
                self.assertRegex(self.execute(self.scene(cuts=cuts), "--explain",
                                              *overrides(keys), code=1).text,
                                 message)

