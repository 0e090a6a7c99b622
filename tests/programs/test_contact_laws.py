# ranks: 1
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contact must keep to in any scene: forces that balance, sliding without
friction and without a ripple, no memory after a release, the same in any frame;
and balls that press as elasticity says."""
import math

import numpy as np

from tests.common.bodies import BodiesTest, annulus, block, circle, rectangle
from morula.run import Run
from tests.common.program import read_csv
from tests.verification import pressed_ball


def icosphere(radius, center, fineness=4):
    """Corners and triangles of a closed polyhedron with the volume of the ball."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(x, y * g, 0) for x in (-1, 1) for y in (-1, 1)]
    corners += [(0, x, y * g) for x in (-1, 1) for y in (-1, 1)]
    corners += [(y * g, 0, x) for x in (-1, 1) for y in (-1, 1)]
    corners = np.array(corners, dtype=float)
    triangles = [t for i in range(12) for j in range(i) for k in range(j)
                 for t in [(k, j, i)]
                 if all(abs(np.linalg.norm(corners[a] - corners[b]) - 2) < 1e-9
                        for a, b in ((i, j), (j, k), (k, i)))]
    for _ in range(fineness):
        middles, finer, corners = {}, [], list(corners)

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                middles[key] = len(corners)
                corners.append((corners[a] + corners[b]) / 2)
            return middles[key]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
        corners = np.array([x / np.linalg.norm(x) for x in corners])
    volume, outward = 0.0, []
    for a, b, c in triangles:
        six = np.dot(corners[a], np.cross(corners[b], corners[c]))
        volume += abs(six) / 6
        outward.append((a, b, c) if six > 0 else (a, c, b))
    scale = radius * (4 * math.pi / 3 / volume) ** (1 / 3)
    return corners * scale + np.array(center), outward


class ContactLaws(BodiesTest):
    def slide(self):
        """A block of 40 um that is pressed on a longer one and drawn over it."""
        cells = block(0, 30, "a") + [
            (x - 60, y, v, t) for x, y, v, t in block(0, 30, "a")]
        cells += [(x + 60, y, v, t) for x, y, v, t in block(0, 30, "a")]
        cells += [(x - 10, y, v, t) for x, y, v, t in block(30.001, 60.001, "b")
                  if x < 40]
        return self.scene(cells, [
            [[(-60, 0), (120, 0), (120, 30), (-60, 30), (-60, 0)]],
            [[(-10, 30.001), (30, 30.001), (30, 60.001), (-10, 60.001),
              (-10, 30.001)]]])

    def test_a_block_slides(self):
        """over four grid spacings: its weight on the other one stays, and none of
        it is friction."""
        rows = self.run_scene(self.slide(), {
            "Boundary conditions/Fixed where": "Y < 0.001 || Y > 60",
            "Boundary conditions/Displacement":
            "if(Y > 30, 40*max(t - 0.2, 0), 0); if(Y > 30, -2*min(t/0.2, 1), 0)",
            "Tissue/Boundary points": "224", "Time/End time": "1.2",
            "Time/Step": "0.05", "Output/Interval": "0.05"})
        self.assertEqual(rows["rejected_steps"].sum(), 0)
        sliding = self.forces()
        sliding = sliding[sliding["time"] > 0.201]
        normal = sliding["force_y"]
        self.assertEqual(len(normal), 20)
        self.assertLess(np.std(normal) / np.mean(normal), 1e-2)
        self.assertLess(np.max(abs(sliding["force_x"])) / np.mean(normal), 1e-2)

    def test_a_long_layer_slides(self):
        """A layer of 120 grid spacings that is squeezed out from under another
        one, up to a third of a spacing in a step: the drag that keeps surfaces
        together in a turn does not hold it back."""
        rows = [[(2 * i + 1, y + 2 * j + 1, 4, body)
                 for j in range(18) for i in range(600)]
                for y, body in ((0, "a"), (36.0001, "b"))]
        outlines = [[(0, y), (1200, y), (1200, y + 36), (0, y + 36), (0, y)]
                    for y in (0, 36.0001)]
        found = self.run_scene(
            self.scene(rows[0] + rows[1], [[ring] for ring in outlines]), {
                "Boundary conditions/Slip where": "X < 0.001 || Y < 0.001",
                "Boundary conditions/Fixed where": "Y > 72",
                "Boundary conditions/Displacement": "0; -7.2*t",
                "Tissue/Boundary points": "1978", "Grid/Offset": "3.1, 4.7",
                "Time/End time": "0.2", "Time/Step": "0.05"})
        self.assertEqual(found["rejected_steps"].sum(), 0)
        self.assertLessEqual(max(found["turns"]), 10)
        last = self.forces().iloc[-1]
        self.assertLess(abs(last["force_x"]), 6e-3 * abs(last["force_y"]))

    def test_pressed_and_released(self):
        """Two blocks that were pressed together by a tenth of their height, and
        released, are as before: no force is left, and no cell is deformed."""
        scene = self.blocks(1e-4)
        self.run_scene(scene, {
            **self.press(60, "6*min(5*t, 2 - 5*t) - 0.5*(t > 0.3)"),
            "Output/Interval": "0.2"})
        self.assertEqual(list(self.forces()["time"]), [0.2])
        cells = read_csv(self.work / "output/cells-0002.csv")
        self.assertLess(np.max(abs(cells["elastic_volume_ratio"] - 1)), 1e-2)
        pressed = read_csv(self.work / "output/cells-0001.csv")
        for name in ("xx", "yy", "xy"):
            self.assertLess(np.max(abs(cells[f"sigma_{name}"])),
                            1e-2 * np.max(abs(pressed["sigma_yy"])))

    def test_frames(self):
        """Two unequal discs, pressed together aslant, seen in a mirror and turned
        by a quarter, with the grid: the same forces."""
        found = []
        for frame in (lambda x, y: (x, y), lambda x, y: (-x, y),
                      lambda x, y: (-y, x)):
            def turned(cells, frame=frame):
                return [(*frame(x, y), v, t) for x, y, v, t in cells]
            cells = annulus(0, 20, "a", 20.02) + [
                (x + 5, y, v, t) for x, y, v, t in annulus(0, 26, "b", -26.02)]
            rings = [circle(20, 20.02), [(x + 5, y) for x, y in circle(26, -26.02)]]
            rings = [[frame(*x) for x in ring] for ring in rings]
            if frame(1, 0) == (-1, 0):
                rings = [ring[::-1] for ring in rings]
            one, other = frame(0, 1)
            height = f"({one}*X + {other}*Y)"
            way = f"if({height} > 0, -5*t, 0)"
            offset = frame(3, 7)
            self.run_scene(self.scene(turned(cells), [[ring] for ring in rings]), {
                "Tissue/Boundary points": "300", "Output/Interval": "0.4",
                "Grid/Offset": f"{offset[0]}, {offset[1]}",
                "Solver/Newton tolerance": "1e-9",
                "Boundary conditions/Fixed where": f"abs({height}) > 37",
                "Boundary conditions/Displacement":
                f"{one}*{way}; {other}*{way}"})
            last = self.forces().iloc[-1]
            across = frame(1, 0)
            found.append([last["force_x"] * a + last["force_y"] * b
                          for a, b in (across, (one, other))])
        for force in found[1:]:
            for a, b in zip(force, found[0]):
                self.assertAlmostEqual(a, b, delta=1e-4 * abs(found[0][1]))

    def test_forces_balance(self):
        """What the two sides of a slit do to each other is no force on the body."""
        scene = self.scene(block(0, 60, "a"), [[
            [(0, 0), (60, 0), (60, 60), (0, 60), (0, 30.00005), (30, 30),
             (0, 29.99995), (0, 0)]]])
        self.run_scene(scene, {
            "Tissue/Boundary points": "300", "Contact/Between": "all",
            "Boundary conditions/Slip where": "Y < 0.001",
            "Boundary conditions/Fixed where": "Y > 59.999",
            "Boundary conditions/Displacement": "0; -10*t"})
        last = self.forces().iloc[-1]
        self.assertEqual(last["name"], "body 0 on itself")
        inward = last["force_inward"]
        self.assertGreater(inward, 2)
        for axis in "xy":
            self.assertLess(abs(last[f"force_{axis}"]), 1e-12 * inward)

    def test_two_balls_press_as_elasticity_says(self):
        """Two balls between planes are two times one ball."""
        R, h, gap = 60, 10, 5
        corners, triangles = [], []
        for sign in (1, -1):
            x, t = icosphere(R, (0, 0, sign * (R + gap / 2)))
            triangles += [[i + len(corners) for i in one] for one in t]
            corners += list(x)
        self.write("balls.off", "\n".join(
            ["OFF", f"{len(corners)} {len(triangles)} 0"]
            + ["%.9f %.9f %.9f" % tuple(x) for x in corners]
            + ["3 %d %d %d" % tuple(t) for t in triangles]) + "\n")
        scene = self.write("scene.prm", BALLS)
        self.execute(scene, "--replace")
        forces = Run(self.work / "output").forces
        last = forces[forces["time"] == 9]
        # A plane gives way by p/kappa, the other ball by half of it.
        ball = pressed_ball.Ball((0.4 / (1.4 * 0.2), 1 / 2.8))
        exact = R**2 * pressed_ball.force(ball, (2 * 9 - gap) / 4 / R,
                                          0.75 * h / 100 / R)
        contact = abs(last[last["kind"] == "contact"].iloc[0]["force_z"])
        for force in abs(last[last["kind"] == "obstacle"]["force_z"]):
            self.assertAlmostEqual(force / contact, 1, delta=1e-2)
        self.assertAlmostEqual(contact / exact, 1, delta=3e-2)


BALLS = """
subsection Time
  set End time = 9
  set Step     = 1
end
subsection Tissue
  set Shape           = mesh
  set Surface mesh    = balls.off
  set Cell spacing    = 5
  set Surface cells   = trimmed
  set Boundary points = 6000
end
subsection Grid
  set Spacing = 10
  set Offset  = 3, 7, 4
end
subsection Contact
  set Between = bodies
end
subsection Material
  set Young's modulus = 1
  set Poisson's ratio = 0.4
end
subsection Obstacles
  set Names = upper, lower
  subsection upper
    set Shape    = plane
    set Center   = 0, 0, 122.5
    set Normal   = 0, 0, -1
    set Velocity = 0; 0; -1
  end
  subsection lower
    set Shape    = plane
    set Center   = 0, 0, -122.5
    set Normal   = 0, 0, 1
    set Velocity = 0; 0; 1
  end
end
subsection Output
  set Formats  = csv
  set Interval = 1
end
"""

