# ranks: 3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue that touches itself: a slit that closes and opens, the arms of a hairpin
that are pressed together and drawn apart."""
import math
import random

import numpy as np

from morula.run import Run
from tests.common.program import TESTS, ProgramTest, overrides, read_csv

SCENE = """
subsection Time
  set End time = 0.4
  set Step     = 0.1
end
subsection Tissue
  set Shape          = points
  set Points file    = cells.csv
  set Points surface = surface.{ending}
end
subsection Grid
  set Spacing = 10
end
subsection Contact
  set Between = all
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


SNAP = """
set Dimension = 2
subsection Time
  set End time = {end}
  set Step     = 0.05
end
subsection Tissue
  set Refine surface  = true
  set Coarsen surface = true
  {tissue}
end
subsection Grid
  set Spacing = 8
end
subsection Contact
  set Between = all
end
subsection Material
  set Poisson's ratio   = 0.45
  set Energy per        = grown volume
  set Volumetric strain = pooled
end
subsection Growth
  set Law = rate
  subsection Rate
    set Rate        = {rate}
    set Share along = 0
    set Direction   = {direction}
  end
end
subsection Division by size
  set Volume = 18
  set Noise  = 0.1
end
subsection Friction
  set Coefficient = {friction}
end
subsection Output
  set Formats  = csv
  set Interval = 0.05
end
"""


class Strip:
    """A strip that is bent by 180 degrees around a gap, along x."""

    def __init__(self, thickness, gap, length):
        self.inner, self.outer = gap / 2, gap / 2 + thickness
        self.length, self.thickness = length, thickness

    def cells(self, side):
        """x, y and area of cells with edges of about this length (um)."""
        n = max(2, round(self.thickness / side))
        across = self.thickness / n
        for k in range(n):
            r = self.inner + (k + 0.5) * across
            for i in range(round(self.length / side)):
                for sign in (-1, 1):
                    yield (i + 0.5) * side, sign * r, side * across
            m = max(3, round(math.pi * r / side))
            for j in range(m):
                angle = math.pi / 2 + (j + 0.5) * math.pi / m
                yield (r * math.cos(angle), r * math.sin(angle),
                       math.pi * r / m * across)

    def side(self, r, n):
        """One side of the strip, from the lower arm's end to the upper one's."""
        turn = [(r * math.cos(a), r * math.sin(a)) for a in
                (-math.pi / 2 - math.pi * j / n for j in range(1, n))]
        return [(self.length, -r), (0, -r), *turn, (0, r), (self.length, r)]


class Folds(ProgramTest):
    def write_scene(self, cells, surface, ending, dim=2):
        names = "x,y,z,volume" if dim == 3 else "x,y,volume"
        self.write("cells.csv", "\n".join(
            [names] + [",".join(f"{value:.9f}" for value in cell)
                       for cell in cells]) + "\n")
        self.write(f"surface.{ending}", surface)
        return self.write("scene.prm", f"set Dimension = {dim}\n"
                          + SCENE.replace("{ending}", ending))

    def polygon(self, cells, ring):
        return self.write_scene(cells, "POLYGON((" + ", ".join(
            f"{x:.9f} {y:.9f}" for x, y in [*ring, ring[0]]) + "))\n", "wkt")

    def run_scene(self, scene, keys, ranks=1):
        self.execute(scene, "--replace", *overrides(keys), ranks=ranks)
        return Run(self.work / "output").forces

    @staticmethod
    def last(forces, name):
        return forces[forces["name"] == name].iloc[-1]

    def slit(self, width, noise=0.0):
        """A block of 60 um, slit from its left side to its middle, with cells of
        2 um that are moved by up to this part of that."""
        generator = random.Random(1)
        cells = [(*(1 + 2 * i + 2 * noise * generator.uniform(-1, 1)
                    for i in place), 4)
                 for place in ((i, j) for j in range(30) for i in range(30))]
        mouth = [(0, 30 + width / 2), (30, 30), (0, 30 - width / 2)]
        return self.polygon(cells, [(0, 0), (60, 0), (60, 60), (0, 60)]
                            + (mouth if width > 0 else []))

    def test_a_slit_carries_pressure_and_no_tension(self):
        keys = {"Boundary conditions/Slip where": "Y < 0.001",
                "Boundary conditions/Fixed where": "Y > 59.999"}
        for offset, noise in (("0, 0", 0), ("3, 7", 0), ("0, 5", 0.2)):
            found = {}
            for width, points in ((0, 240), (1e-4, 300)):
                scene = self.slit(width, noise)
                for way in ("-10*t", "10*t"):
                    forces = self.run_scene(
                        scene, {**keys, "Grid/Offset": offset,
                                "Tissue/Boundary points": str(points),
                                "Boundary conditions/Displacement": f"0; {way}"})
                    found[width, way] = self.last(forces, "fixed")["force_y"]
                    points_of = read_csv(self.work / "output/surface-0004.csv")
                    at_slit = ((abs(points_of["Y"] - 30) < 0.01)
                               & (points_of["X"] > 1) & (points_of["X"] < 29))
                    sides = [points_of[at_slit & (sign * points_of["ny"] > 0)]
                             for sign in (1, -1)]
                    if width > 0:
                        lower, upper = (np.interp(
                            np.arange(2, 28), np.sort(side["x"]),
                            side["y"][np.argsort(side["x"])]) for side in sides)
                        # p/kappa is 0.009 um
                        if way == "-10*t":
                            self.assertGreater(np.min(upper - lower), -0.05)
                            self.assertLess(np.max(upper - lower), 0.01)
                        else:
                            self.assertGreater(np.max(upper - lower), 2.5)
            self.assertAlmostEqual(found[1e-4, "-10*t"] / found[0, "-10*t"], 1,
                                   delta=3e-3)
            self.assertLess(found[1e-4, "10*t"], 0.9 * found[0, "10*t"])

    def hairpin_keys(self, strip, points):
        return {"Time/End time": "2",
                "Tissue/Boundary points": str(points),
                "Boundary conditions/Fixed where":
                f"X > 10 && abs(Y) > {strip.outer - 0.001}",
                "Boundary conditions/Displacement":
                "0; if(Y > 0, -if(t < 1, 12*t, 12*(2 - t)), 0)"}

    def check_closing_and_opening(self, forces, dim):
        """Contact begins when the gap of 10 um is used up, and ends when it is
        back, with the same forces on the way in and out."""
        rows = forces[forces["name"] == "body 0 on itself"]
        times = [round(t, 6) for t in rows["time"]]
        self.assertGreaterEqual(times[0], 0.7)
        self.assertLessEqual(times[-1], 1.3)
        inward = dict(zip(times, rows["force_inward"]))
        self.assertAlmostEqual(inward[0.9], inward[1.1],
                               delta=(0.03 if dim == 2 else 0.1) * inward[1.0])
        self.assertGreater(inward[1.0], 5 * inward.get(0.8, 0.0))
        for name in ("force_x", "force_y"):
            self.assertLess(max(abs(rows[name])), 1e-9 * inward[1.0])
        self.assertLess(np.hypot(*(rows[f"moment_{axis}"].iloc[-1]
                                   for axis in "yz")) if dim == 3 else 0.0,
                        0.1 * inward[1.0])

    def test_a_hairpin_closes_and_opens(self):
        """on any ranks, and resumed in contact bit for bit."""
        for thickness in (20, 6):
            strip = Strip(thickness, 10, 40)
            scene = self.polygon(list(strip.cells(2)),
                                 strip.side(strip.inner, 24)
                                 + strip.side(strip.outer, 48)[::-1])
            keys = self.hairpin_keys(strip, round(
                (160 + math.pi * (strip.inner + strip.outer)) / 2))
            self.check_closing_and_opening(self.run_scene(scene, keys), 2)
        files = ("cells-0010", "surface-0020", "cells-0020", "forces")
        whole = [(self.work / f"output/{name}.csv").read_bytes()
                 for name in files]
        alone = read_csv(self.work / "output/cells-0010.csv")
        self.run_scene(scene, {**keys, "Time/End time": "1.1"})
        self.execute(scene, "--resume", *overrides(keys))
        self.assertEqual(whole, [(self.work / f"output/{name}.csv").read_bytes()
                                 for name in files])
        self.run_scene(scene, {**keys, "Time/End time": "1"}, ranks=3)
        together = read_csv(self.work / "output/cells-0010.csv")
        order = [np.argsort(table["id"]) for table in (alone, together)]
        for name in ("x", "y"):
            self.assertLess(np.max(abs(alone[name][order[0]]
                                       - together[name][order[1]])), 1e-5)

    def test_a_hairpin_in_3d(self):
        strip, width, side = Strip(10, 10, 40), 10, 2.5
        cells = [(x, y, (k + 0.5) * side, area * side)
                 for x, y, area in strip.cells(side) for k in range(4)]
        corners, triangles = [], []
        rows = []
        for r in (strip.inner, strip.outer):
            for z in (0, width):
                rows.append(range(len(corners),
                                  len(corners) + len(strip.side(r, 12))))
                corners += [(x, y, z) for x, y in strip.side(r, 12)]
        n = len(rows[0])

        def quad(a, b, c, d):
            triangles.extend([(a, b, c), (a, c, d)])
        # around the cross-section, and its two ends
        for one, other in ((0, 1), (1, 3), (3, 2), (2, 0)):
            for i in range(n - 1):
                quad(rows[one][i], rows[one][i + 1],
                     rows[other][i + 1], rows[other][i])
        quad(*(rows[k][0] for k in (0, 1, 3, 2)))
        quad(*(rows[k][n - 1] for k in (2, 3, 1, 0)))
        surface = "\n".join(["OFF", f"{len(corners)} {len(triangles)} 0"]
                            + ["%.9g %.9g %.9g" % corner for corner in corners]
                            + ["3 %d %d %d" % triangle for triangle in triangles])
        scene = self.write_scene(cells, surface + "\n", "off", dim=3)
        keys = {**self.hairpin_keys(strip, 900),
                "Boundary conditions/Displacement":
                "0; if(Y > 0, -if(t < 1, 12*t, 12*(2 - t)), 0); 0"}
        self.check_closing_and_opening(self.run_scene(scene, keys, 2), 3)

    def two_blocks(self):
        """Blocks of 60 um by 30 um, 2 um apart."""
        cells = [(1 + 2 * i, y + 1 + 2 * j, 4) for y in (0, 32)
                 for j in range(15) for i in range(30)]
        return self.write_scene(
            cells, "MULTIPOLYGON(((0 0, 60 0, 60 30, 0 30, 0 0)), "
            "((0 32, 60 32, 60 62, 0 62, 0 32)))\n", "wkt")

    def test_bodies_touch_as_with_bodies_alone(self):
        """Two blocks press on each other as where only bodies can touch."""
        scene = self.two_blocks()
        keys = {"Boundary conditions/Slip where":
                "X < 0.001 || X > 59.999 || Y < 0.001",
                "Boundary conditions/Fixed where": "Y > 61.999",
                "Boundary conditions/Displacement": "0; -15*t",
                "Tissue/Boundary points": "144"}
        found = [self.last(self.run_scene(scene, {**keys,
                                                  "Contact/Between": between}),
                           "body 0 on body 1")["force_y"]
                 for between in ("bodies", "all")]
        self.assertAlmostEqual(*found, delta=1e-3 * found[0])

    def test_strands_fuse(self):
        """The sides of a slit, and two blocks, that have been pressed on each
        other for some time are one tissue: it is drawn as if there had been no
        surface."""
        for offset in ("0, 0", "3, 7"):
            drawn = []
            for make, top, points in ((lambda: self.slit(0), 60, 240),
                                      (lambda: self.slit(1e-4), 60, 300),
                                      (self.two_blocks, 62, 360)):
                forces = self.run_scene(make(), {
                    "Boundary conditions/Slip where": "Y < 0.001",
                    "Boundary conditions/Fixed where": f"Y > {top - 0.001}",
                    "Boundary conditions/Displacement":
                    f"0; {60 - top} + if(t < 0.35, -3*min(10*t, 1), "
                    "-3 + 15*(t - 0.35))",
                    "Tissue/Boundary points": str(points),
                    "Tissue/Refine surface": "true", "Time/End time": "0.75",
                    "Time/Step": "0.05", "Grid/Offset": offset,
                    "Contact/Fusion time": "0.2"})
                drawn.append(self.last(forces, "fixed")["force_y"])
                rows = read_csv(self.work / "output/surface-0007.csv")
                self.assertEqual(set(rows["body"]), {0})
                for axis in "xy":
                    self.assertLess(
                        abs(np.sum(rows["area"] * rows[f"n{axis}"])),
                        1e-3 * np.sum(rows["area"]))
            for force in drawn:
                self.assertAlmostEqual(force / drawn[0], 1, delta=3e-3)

    def test_a_fold_whose_surface_is_made_anew(self):
        """closes and opens as before."""
        strip = Strip(20, 10, 40)
        scene = self.polygon(list(strip.cells(2)),
                             strip.side(strip.inner, 24)
                             + strip.side(strip.outer, 48)[::-1])
        keys = {**self.hairpin_keys(strip, 150), "Tissue/Renew surface": "0.2",
                "Tissue/Refine surface": "true",
                "Tissue/Coarsen surface": "true"}
        self.check_closing_and_opening(self.run_scene(scene, keys), 2)

    def most_crowded(self, name):
        """The largest part of a square of 16 um that cells fill: 2 where tissue
        has passed through itself."""
        cells = read_csv(self.work / f"output/{name}.csv")
        edges = np.arange(-160, 161, 16)
        filled, _, _ = np.histogram2d(cells["x"], cells["y"], bins=[edges, edges],
                                      weights=cells["volume"])
        return np.max(filled) / 256

    @staticmethod
    def deepest_overlap(points):
        """How deep a point of the surface is in what faces it (um). Between two
        points the other surface is the mean of the chord and of their tangents,
        which is exact for an arc: g of (4.8k) is not where bulges meet."""
        x, n = (np.column_stack([points[name + axis] for axis in "xy"])
                for name in ("", "n"))
        deepest = 0.0
        for i in range(len(x)):
            away = x - x[i]
            facing = (n @ n[i] < -0.3) & (np.linalg.norm(away, axis=1) < 10)
            along = away @ np.array([-n[i][1], n[i][0]])
            before, after = facing & (along <= 0), facing & (along > 0)
            if not before.any() or not after.any():
                continue
            one = np.argmax(np.where(before, along, -np.inf))
            other = np.argmin(np.where(after, along, np.inf))
            if along[other] - along[one] > 6:
                continue
            weight = along[other] / (along[other] - along[one])
            gap = sum(w * (away[j] @ n[i] - away[j] @ n[j]) / 2
                      for j, w in ((one, weight), (other, 1 - weight)))
            deepest = max(deepest, -gap)
        return deepest

    def test_a_surface_that_snaps_into_folds(self):
        """A growing layer is smooth, and then has sulci whose sides press on each
        other: nothing faced them before the step in which they met."""
        scene = self.write("scene.prm", SNAP.format(
            end=1, friction=1e-5, rate="normal(1, 0.01)*(X^2 + Y^2 > 60^2)",
            direction="radial",
            tissue="set Radius = 80\n  set Cell spacing = 3"))
        self.execute(scene, "--replace")
        rows = read_csv(self.work / "output/statistics.csv")
        self.assertLess(self.most_crowded("cells-0016"), 1.35)
        self.assertGreater(sum(rows["rejected_steps"]), 0)
        points = read_csv(self.work / "output/surface-0016.csv")
        self.assertGreater(max(points["contact_pressure"]), 0.05)
        last = read_csv(self.work / "output/surface-0020.csv")
        self.assertLess(self.deepest_overlap(last), 0.03 * 8)
        # With less friction it snaps within a step.
        alone = self.execute(scene, "--replace",
                             *overrides({"Contact/Between": "none",
                                         "Friction/Coefficient": "1e-6",
                                         "Time/End time": "0.8"}))
        self.assertIn("It may pass through itself there", alone.text)
        self.assertGreater(self.most_crowded("cells-0016"), 1.7)

    def test_a_snap_in_slow_steps(self):
        """A drag holds a layer back for some steps, also in a resumed run."""
        scene = self.write("scene.prm", SNAP.format(
            end=0.45, friction=1e-6, rate="normal(1.5, 0.02)*(Y > 10)",
            direction="0; 1",
            tissue="set Shape = box\n  set Size = 80, 60\n  set Cell spacing = 2.5")
            + "subsection Boundary conditions\n"
            "  set Slip where = abs(X) > 39.999\n"
            "  set Fixed where = Y < -29.999\nend\n")
        self.execute(scene, "--replace")
        rows = read_csv(self.work / "output/statistics.csv")
        self.assertGreater(sum(rows["proximal_paths"]), 3)
        self.assertLess(self.most_crowded("cells-0009"), 1.35)
        names = ("cells-0009", "surface-0009", "lineage")
        whole = [(self.work / f"output/{name}.csv").read_bytes()
                 for name in names]
        self.execute(scene, "--replace",
                     *overrides({"Time/End time": "0.4"}))
        self.execute(scene, "--resume")
        self.assertTrue(whole == [(self.work / f"output/{name}.csv").read_bytes()
                                  for name in names])

    def test_creases_close_and_open(self):
        """A layer grows until it has creases, and shrinks until it has none.
        Planes stand behind the slip walls, which no point of the surface above
        them keeps in its place."""
        planes = {}
        for name, side in (("left", 1), ("right", -1)):
            planes.update({f"Obstacles/{name}/Shape": "plane",
                           f"Obstacles/{name}/Center": f"{-200 * side}, 0",
                           f"Obstacles/{name}/Normal": f"{side}; 0"})
        self.execute(TESTS.parent / "prm/hard/growing-layer.prm", "--replace", *overrides({
            "Time/End time": "1.36", "Grid/Spacing": "12",
            "Tissue/Cell spacing": "4", "Tissue/Refine surface": "true",
            "Tissue/Coarsen surface": "true", "Contact/Between": "all",
            "Growth/Isotropic/Stretch": "if(t < 0.85, 1 + t, 2.7 - t)",
            "Obstacles/Names": "left, right", **planes}))
        run = Run(self.work / "output")
        times = run.forces[run.forces["name"] == "body 0 on itself"]["time"]
        self.assertGreater(len(times), 5)
        self.assertLess(max(times), 1.1)

        def depth(time):
            points = run.surface(round(time / 0.02))
            top = points["y"][points["Y"] > 79.9]
            return max(top) - min(top)
        self.assertGreater(depth(0.84), 40)
        self.assertLess(depth(1.36), 0.2 * depth(0.84))

    def test_sheets_do_not_touch_themselves(self):
        """The two faces of a bent sheet of few cells are no pair: it moves as
        without contact, to the last digit."""
        for n, side in ((2, 2.5), (3, 2.5), (1, 5), (2, 5)):
            cells = [((i + 0.5) * side, (j + 0.5) * side, side * side)
                     for i in range(round(100 / side)) for j in range(n)]
            width = n * side
            scene = self.polygon(
                cells, [(0, 0), (100, 0), (100, width), (0, width)])
            moved = []
            for between in ("all", "none"):
                self.execute(scene, "--replace", *overrides({
                    "Contact/Between": between,
                    "Tissue/Boundary points": str(round((200 + 2 * width) / side)),
                    "Boundary conditions/Fixed where": "X < 0.001",
                    "Body force/Force density": f"0; -{4e-7 * width**2}*t",
                    "Grid/Offset": "3, 7"}))
                cells_of = read_csv(self.work / "output/cells-0004.csv")
                moved.append((cells_of["x"], cells_of["y"]))
            self.assertGreater(max(cells_of["Y"] - cells_of["y"]), 1)
            self.assertTrue(np.array_equal(*moved))

    def test_what_is_said(self):
        self.assertIn("1 body, whose folds and arms have contact, too",
                      self.execute(self.slit(1e-4), "--explain").text)

