# ranks: 3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies in contact against closed forms: they press, slide, part again, and no
step lets them pass through each other."""
import math

import numpy as np

from morula.run import Run
from tests.common.bodies import SCENE, BodiesTest, annulus, block, circle, rectangle
from tests.common.program import overrides, read_csv



class Contact(BodiesTest):
    def test_blocks_press_as_one(self):
        """Uniaxial strain of two blocks, also of unequal ones, wherever the grid
        lies and on any ranks: pressure and evenness."""
        scene = self.blocks(1e-4)
        found = []
        for ranks, offset, E, exact, within in (
                (1, "0, 0", "1", 0.1542733, 1e-3),
                (2, "0, 0", "1", 0.1542733, 1e-3),
                (3, "3.7, 6.1", "1", 0.1542733, 1e-3),
                (1, "8.9, 8.9", "1", 0.1542733, 1e-3),
                (1, "1.3, 5", "if(type == b, 10, 1)", 0.2978, 2e-3)):
            self.run_scene(scene, {**self.press(60, "10*t"), "Grid/Offset": offset,
                                   "Material/Young's modulus": E}, ranks)
            last = self.forces().iloc[-1]
            self.assertEqual(last["name"], "body 0 on body 1")
            self.assertAlmostEqual(last["force_y"] / 60 / exact, 1, delta=within)
            found.append(last["force_y"])
            if E == "1":
                cells = read_csv(self.work / "output/cells-0004.csv")
                stress = cells["sigma_yy"]
                self.assertLess(np.std(stress), 8e-3 * abs(np.mean(stress)))
                points = read_csv(self.work / "output/surface-0004.csv")
                middle = ((abs(points["ny"]) > 0.9) & (abs(points["Y"] - 30) < 1)
                          & (abs(points["x"] - 30) < 20))
                self.assertLess(np.max(abs(points["contact_pressure"][middle]
                                           / exact - 1)), 0.03)
        self.assertAlmostEqual(found[0], found[1], delta=1e-5 * found[0])

    def test_core_in_a_ring(self):
        """A core that grows in a ring, and a ring that grows off its core: the
        radial equations with the penalty; resumed bit for bit."""
        scene = self.scene(annulus(0, 20, "a") + annulus(20, 40, "b"),
                           [[circle(20)], [circle(40), circle(20.001, sign=-1)]])
        keys = {"Tissue/Boundary points": "300", "Tissue/Refine surface": "true",
                "Time/End time": "2", "Time/Step": "0.5", "Output/Interval": "1",
                "Growth/Law": "rate",
                "Growth/Rate/Rate": "(type == a)*0.2/(1 + 0.1*t)"}
        statistics = self.run_scene(scene, keys)
        self.assertLessEqual(max(statistics["newton_iterations"]), 12)
        for row, exact in zip(self.forces().to_dict("records"), (0.0391286, 0.06945)):
            self.assertAlmostEqual(row["force_inward"] / row["area"] / exact, 1,
                                   delta=5e-3)
            self.assertLess(math.hypot(row["force_x"], row["force_y"]),
                            1e-3 * row["force_inward"])
        self.assertAlmostEqual(statistics["xmax"][-1] - statistics["xmax"][0],
                               2.004, delta=0.01)
        whole = [(self.work / f"output/{name}.csv").read_bytes()
                 for name in ("cells-0002", "surface-0002", "forces")]
        # anywhere on the grid, also in a softer ring
        for offset, ring, exact in (("7.4, 9.2", 1, 0.0391286),
                                    ("0.3, 4.7", 1, 0.0391286),
                                    ("9, 1.1", 0.2, 0.0087181)):
            self.run_scene(scene, {
                **keys, "Grid/Offset": offset, "Time/End time": "1",
                "Material/Young's modulus": f"if(type == b, {ring}, 1)"})
            row = self.forces().iloc[-1]
            self.assertAlmostEqual(row["force_inward"] / row["area"] / exact, 1,
                                   delta=5e-3 if ring == 1 else 1e-2)
        self.run_scene(scene, {**keys, "Time/End time": "1"})
        self.execute(scene, "--resume", *overrides(keys))
        self.assertEqual(whole, [(self.work / f"output/{name}.csv")
                                 .read_bytes()
                                 for name in ("cells-0002", "surface-0002",
                                              "forces")])

        self.run_scene(scene, {**keys, "Growth/Rate/Rate":
                               "(type == b)*0.2/(1 + 0.1*t)"})
        self.assertEqual(len(self.forces()), 0)
        points = read_csv(self.work / "output/surface-0002.csv")
        radius = np.hypot(points["x"], points["y"])
        inner = radius[(points["body"] == 1) & (radius < 30)]
        start = np.hypot(points["X"], points["Y"])[(points["body"] == 1)
                                                   & (radius < 30)]
        self.assertLess(np.max(abs(inner / start - 1.2)), 1e-3)
        core = read_csv(self.work / "output/cells-0002.csv")
        core = core[core["body"] == 0]
        self.assertLess(np.max(np.hypot(core["x"] - core["X"],
                                        core["y"] - core["Y"])), 1e-4)
        self.assertLess(max(np.max(abs(core[f"sigma_{i}"]))
                            for i in ("xx", "yy", "xy")), 1e-8)

    def test_two_discs_are_one_at_a_mirror(self):
        """Two discs between clamps press as one against a plane: exact by
        symmetry."""
        keys = {"Time/End time": "1", "Output/Interval": "1"}
        for offset in ("0, 0", "3, 7"):
            scene = self.scene(
                annulus(0, 40, "a", 40.02) + annulus(0, 40, "b", -40.02),
                [[circle(40, 40.02)], [circle(40, -40.02)]])
            self.run_scene(scene, {
                **keys, "Grid/Offset": offset, "Tissue/Boundary points": "250",
                "Boundary conditions/Fixed where": "abs(Y) > 77",
                "Boundary conditions/Displacement": "0; if(Y > 0, -8*t, 0)"})
            two = -self.forces().iloc[-1]["force_y"]
            text = SCENE + """
subsection Obstacles
  set Names = floor
  subsection floor
    set Shape  = plane
    set Normal = 0; 1
  end
end
"""
            scene = self.scene(annulus(0, 40, "a", 40.02), [[circle(40, 40.02)]],
                               text)
            self.run_scene(scene, {
                **keys, "Grid/Offset": offset, "Tissue/Boundary points": "125",
                "Contact/Between": "none",
                "Boundary conditions/Fixed where": "Y > 77",
                "Boundary conditions/Displacement": "0; -4*t"})
            rows = Run(self.work / "output").forces
            one = rows[rows["kind"] == "obstacle"].iloc[-1]["force_y"]
            self.assertAlmostEqual(two / one, 1, delta=0.01)

    def test_no_step_is_too_long(self):
        """A lid that comes down by two grid spacings in one step stops at the
        block below; drawn back it leaves no force."""
        scene = self.blocks(10)
        rows = self.run_scene(scene, {**self.press(70, "20*t"),
                                      "Time/End time": "1", "Time/Step": "1",
                                      "Output/Interval": "1"})
        self.assertGreater(rows["rejected_steps"].sum(), 0)
        self.assertGreater(self.forces().iloc[-1]["force_y"], 20)
        cells = read_csv(self.work / "output/cells-0001.csv")
        self.assertGreater(min(cells["y"][cells["body"] == 1]),
                           max(cells["y"][cells["body"] == 0]))

        # Nor do bodies pass that are too far apart to be looked at at first.
        far = self.blocks(25)
        rows = self.run_scene(far, {**self.press(85, "30*t"),
                                    "Time/End time": "1", "Time/Step": "1",
                                    "Output/Interval": "1"})
        self.assertGreater(rows["rejected_steps"].sum(), 0)
        self.assertGreater(self.forces().iloc[-1]["force_y"], 5)
        cells = read_csv(self.work / "output/cells-0001.csv")
        self.assertGreater(min(cells["y"][cells["body"] == 1]),
                           max(cells["y"][cells["body"] == 0]))

        scene = self.blocks(10)
        rows = self.run_scene(scene, {**self.press(70, "60*(t - t*t)"),
                                      "Time/End time": "1", "Time/Step": "0.05",
                                      "Output/Interval": "0.25"})
        forces = self.forces()
        self.assertAlmostEqual(forces["force_y"].iloc[0]
                               / forces["force_y"].iloc[-1], 1,
                               delta=2e-3)
        self.assertEqual(forces["time"].iloc[-1], 0.75)
        pressed = np.max(abs(read_csv(self.work / "output/cells-0002.csv")
                             ["sigma_yy"]))
        cells = read_csv(self.work / "output/cells-0004.csv")
        self.assertLess(np.max(abs(cells["sigma_yy"])), 1e-3 * pressed)

    def test_viscous_friction(self):
        """Blocks that slide at a velocity v resist with the friction times v."""
        scene = self.blocks(1e-4)
        self.run_scene(scene, {
            "Boundary conditions/Fixed where": "Y < 0.001 || Y > 59.999",
            "Boundary conditions/Displacement":
            "if(Y > 30, 2*t, 0); if(Y > 30, -0.2*min(t/0.2, 1), 0)",
            "Tissue/Boundary points": "144", "Contact/Friction": "0.01",
            "Material/Young's modulus": "20", "Time/End time": "1", "Output/Interval": "0.5"})
        last = self.forces().iloc[-1]
        self.assertAlmostEqual(last["force_x"] / (-0.01 * 2 * 58), 1, delta=0.03)

    def test_discs_fuse(self):
        """Two discs that have touched for some time become one body with one
        closed surface, whose tension draws it together; on any ranks, and
        resumed bit for bit."""
        scene = self.scene(
            [(y, x, v, t) for x, y, v, t in annulus(0, 20, "a", -22)
             + annulus(0, 20, "b", 22)],
            [[[(y, x) for x, y in reversed(circle(20, center))]]
             for center in (-22, 22)])
        keys = {"Contact/Bodies": "apart", "Contact/Fusion time": "0.2",
                "Contact/Friction": "0.01", "Tissue/Refine surface": "true",
                "Tissue/Coarsen surface": "true", "Growth/Law": "rate",
                "Growth/Rate/Rate": "0.6*(t < 0.6)",
                "Material/Relaxation time": "0.1",
                "Material/Energy per": "grown volume",
                "Material/Volumetric strain": "pooled",
                "Boundary conditions/Surface tension": "0.5",
                "Friction/Coefficient": "1e-6",
                "Time/End time": "2", "Output/Interval": "0.4"}
        rows = self.run_scene(scene, keys)
        surface = read_csv(self.work / "output/surface-0001.csv")
        self.assertEqual(set(surface["body"]), {0, 1})
        surface = read_csv(self.work / "output/surface-0005.csv")
        self.assertEqual(set(surface["body"]), {0})
        for i in ("x", "y"):
            self.assertLess(abs(np.sum(surface["area"] * surface[f"n{i}"])),
                            1e-3 * np.sum(surface["area"]))
        self.assertLess(rows["xmax"][-1] - rows["xmin"][-1],
                        0.97 * max(rows["xmax"] - rows["xmin"]))
        self.assertAlmostEqual(rows["total_volume"][-1]
                               / rows["grown_volume"][-1], 1, delta=0.02)
        names = ("cells-0005", "surface-0005", "lineage")
        whole = [(self.work / f"output/{name}.csv").read_bytes()
                 for name in names]
        self.run_scene(scene, {**keys, "Time/End time": "0.8"})
        self.execute(scene, "--resume", *overrides(keys))
        self.assertEqual(whole, [(self.work / f"output/{name}.csv").read_bytes()
                                 for name in names])
        again = self.run_scene(scene, keys, ranks=2)
        self.assertAlmostEqual(rows["xmax"][-1], again["xmax"][-1], delta=1e-3)

    def test_a_body_that_dies(self):
        """leaves no surface behind; a type without cells is no body."""
        scene = self.blocks(1e-4)
        self.run_scene(scene, {"Tissue/Boundary points": "144",
                               "Cell types/Names": "a, b, c",
                               "Death/When": "t > 0.15 && type == b",
                               "Death/Shrinking time": "0"})
        surface = read_csv(self.work / "output/surface-0004.csv")
        self.assertEqual((len(surface), set(surface["body"])), (72, {0}))
        self.run_scene(scene, {"Tissue/Points surface": "automatic",
                               "Cell types/Names": "a, c, b",
                               "Time/End time": "0.1"})
        surface = read_csv(self.work / "output/surface-0001.csv")
        self.assertEqual(set(surface["body"]), {0, 2})

    def test_fields_that_end_at_each_body(self):
        """A steady and a transient field in bodies that touch, on ranks."""
        scene = self.blocks(1e-4)
        keys = {**self.press(60, "5*t"), "Contact/Fields pass": "false",
                "Fields/Names": "o, m", "Fields/o/Diffusion": "1000",
                "Fields/o/Consumption": "1",
                "Fields/o/Fixed where": "Y < 0.001 || Y > 59.999",
                "Fields/o/Value": "1", "Fields/m/Diffusion": "100",
                "Fields/m/Time": "transient", "Fields/m/Initial": "1",
                "Fields/m/Consumption": "1"}
        lowest = [self.run_scene(scene, keys, ranks)["o_min"][-1]
                  for ranks in (1, 2)]
        self.assertAlmostEqual(*lowest, delta=1e-6)
        together = self.run_scene(scene, {**keys, "Contact/Fields pass": "true"})
        self.assertAlmostEqual(lowest[0], together["o_min"][-1], delta=0.01)

    def test_touching_faces_are_no_surface_for_fields(self):
        """A field that is held at all of the surface: two blocks that touch are
        as one, unless fields end at each of them."""
        keys = {"Fields/Names": "o", "Fields/o/Diffusion": "1000",
                "Fields/o/Consumption": "1", "Fields/o/Fixed where": "1",
                "Fields/o/Value": "1", "Time/End time": "0.1"}
        one = self.scene(block(0, 60, "a"), [[rectangle(0, 60)]])
        whole = self.run_scene(one, {**keys, "Contact/Between": "none"})["o_min"]
        scene = self.blocks(1e-4)
        pressed = {**keys, **self.press(60, "5*t"), "Time/End time": "0.1"}
        for between, ranks in (("bodies", 1), ("all", 2)):
            both = self.run_scene(
                scene, {**pressed, "Contact/Between": between}, ranks)["o_min"]
            for i in (0, -1):
                self.assertAlmostEqual(both[i], whole[0], delta=0.01)
        ends = self.run_scene(scene, {**pressed, "Contact/Fields pass": "false"})
        self.assertGreater(ends["o_min"][0], whole[0] + 0.1)

    def test_what_is_refused(self):
        scene = self.blocks(10)
        for keys, message in (
                ({"Contact/Fusion time": "1"}, "Bodies that fuse get a new"),
                ({"Contact/Friction": "-1"}, "Contact/Friction = '-1'"),
                ({"Contact/Stiffness": "0"}, "Contact/Stiffness = '0'"),
                ({"Contact/Between": "cells"}, "Contact/Between = 'cells'"),
                ({"Tissue/Points surface": "none"},
                 "Bodies touch with their boundary points"),
                ({"Cell types/Names": ""}, "Name the types of the cells"),
                ({"Growth/Law": "isotropic",
                  "Growth/Isotropic/Stretch": "1 + t"},
                 "let bodies pass through each other"),
                ({"Grid/Spacing": "100"}, "contact holds bodies apart from 0.4")):
            self.assertIn(message, self.execute(
                scene, "--replace", *overrides(keys), code=1).text)

    def test_a_surface_around_both(self):
        """is open for each of them, and one body has nothing to touch."""
        cells = block(0, 30, "a") + block(30, 60, "b")
        scene = self.scene(cells, [[rectangle(0, 60)]])
        self.assertIn("the surface of body 0 is open", self.execute(
            scene, "--replace", code=1).text)
        self.assertIn("there is only one body", self.execute(
            scene, "--replace", *overrides({"Contact/Bodies": "apart"})).text)

    def test_what_is_said(self):
        text = self.execute(self.blocks(10), "--explain").text
        self.assertIn("2 bodies, each with splines of its own", text)
        self.assertIn("body 1: 450 cells, 1800 um^2, surface 180 um", text)
        self.assertIn("without friction", text)
        self.assertNotIn("fuse", text)
        text = self.execute(self.blocks(10), "--explain", *overrides({
            "Contact/Friction": "0.25", "Contact/Fusion time": "0.5",
            "Tissue/Refine surface": "true"})).text
        self.assertIn("; friction 0.25 kPa day/um;", text)
        self.assertIn("; bodies that touch for 0.5 day fuse", text)

