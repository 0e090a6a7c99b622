# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/accuracy: what it makes of scenes that it has never seen, and whether
its estimates are right where the truth is known.
"""
import csv
import math
import shutil
import statistics
from pathlib import Path

from morula import columns
from tests.common.program import ProgramTest, read_csv

from tests.verification.radial import GrowingBall, Layer

ROOT = Path(__file__).resolve().parents[2]

# A disc whose cells divide at random.
DISC = """
set Dimension = 2
subsection Time
  set End time = 1
  set Step = 0.25
end
subsection Tissue
  set Radius = 80
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 40
end
subsection Proliferation
  set Law = cell cycle
end
"""

# A disc that grows most at its rim, with nothing random.
GRADED_DISC = """
set Dimension = 2
subsection Time
  set End time = 1
  set Step = 1
end
subsection Tissue
  set Radius = 250
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 50
end
subsection Growth
  set Law = isotropic
  subsection Isotropic
    set Stretch = 1 + 0.4*t*(X^2+Y^2)/250^2
  end
end
subsection Solver
  set Newton tolerance = 1e-9
end
"""

# A cylinder under pressure that stands on a slip plane.
CYLINDER = """
subsection Time
  set End time = 1
  set Step = 1
end
subsection Tissue
  set Shape = cylinder
  set Center = 0, 0, 60
  set Radius = 60
  set Size = 0, 0, 120
  set Cell spacing = 12
end
subsection Grid
  set Spacing = 40
end
subsection Boundary conditions
  set Slip where = Z <= 0
  set Slip normal = 0, 0, 1
  set Pressure where = Z >= 120
  set Pressure = 0.1 * t
end
"""


class AccuracyTest(ProgramTest):
    """With the tool, the program and a directory."""

    def accuracy(self, scene, *arguments, code=0):
        words = [ROOT / "contrib/accuracy", scene, "--output",
                 self.work / "found"]
        if "--morula" not in arguments:
            words += ["--morula", self.options.morula, "--mpiexec",
                      self.options.mpiexec]
        return self.run_words([*map(str, words), *arguments], code)

    def rows(self):
        """table.csv as dictionaries of text."""
        with (self.work / "found/table.csv").open(encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def table(self):
        return (self.work / "found/table.md").read_text(encoding="utf-8")


class UnseenScenes(AccuracyTest):
    def test_disc_that_proliferates(self):
        """Means over seeds, cells' files, a grid of combinations; and the same
        command again does no run twice."""
        scene = self.write("disc.prm", DISC)
        command = [scene, "--grid", "--vary", "Grid/Spacing=80,40",
                   "--vary", "Time/Step=0.25,0.125",
                   "--seeds", "1..3", "--at", "0.5,1", "--measure",
                   "cells,cells:p90(energy_density),surface:max(radius)",
                   "--wanted", "surface:max(radius)=20%"]
        first = self.accuracy(*command)
        rows = self.rows()
        self.assertEqual(len(rows), 4 * 2 * 3)
        scatter = {(row["time"], row["measure"]): float(row["seed_scatter"])
                   for row in rows}
        self.assertTrue(all(value > 0 for (time, _), value in scatter.items()
                            if time == "1"))
        last = [row for row in rows if row["measure"] == "cells"
                and row["time"] == "1" and row["Grid/Spacing"] == "40"
                and row["Time/Step"] == "0.25"]
        counts = [read_csv(file)["cells"][-1] for file in
                  sorted((self.work / "found/runs").glob(
                      "Random-seed=*/output/statistics.csv"))]
        self.assertEqual(len(counts), 3)
        self.assertAlmostEqual(float(last[0]["value"]), sum(counts) / 3)
        for name in ("cells-day-1.png", "alone-day-0.5.png",
                     "surface-max-radius-day-1.png"):
            self.assertTrue((self.work / "found" / name).is_file(), name)
        self.assertNotIn("from before", first.stdout)

        second = self.accuracy(*command)
        self.assertEqual(second.stdout.count("from before"), 12)
        self.assertEqual(self.rows(), rows)

    def test_executable_that_changes(self):
        """Runs of two builds must not be compared: those of the old one are
        done anew, and a build in mid-run ends the command."""
        scene = self.write("disc.prm", DISC)
        copy = self.work / "morula"
        command = [scene, "--morula", str(copy), "--vary",
                   "Grid/Spacing=80,40", "--measure", "xmax"]
        shutil.copy(self.options.morula, copy)
        self.accuracy(*command)
        self.assertEqual(self.accuracy(*command).stdout.count("from before"),
                         2)
        with copy.open("ab") as stream:
            stream.write(b"another build")
        self.assertNotIn("from before", self.accuracy(*command).stdout)

        script = self.write("replaces-itself", "#!/bin/sh\n"
                            "case $* in *--parameters*|*--explain*) ;;\n"
                            f"*) echo '# new' >> {copy} ;; esac\n"
                            f"exec {self.options.morula} \"$@\"\n")
        shutil.copy(script, copy)
        copy.chmod(0o755)
        self.assertIn("nobody replaces",
                      self.accuracy(*command, code=1).stderr)

    def test_cylinder_under_pressure_on_two_ranks(self):
        scene = self.write("cylinder.prm", CYLINDER)
        result = self.accuracy(
            scene, "--ranks", "2", "--vary",
            "Grid/Spacing,Tissue/Cell spacing=60:20,40:12,30:10", "--vary",
            "Solver/Linear solver=iterative,direct", "--measure",
            "zmax,mean_energy_density")
        self.assertIn("tables and figures", result.stdout)
        rows = self.rows()
        self.assertEqual({row["Grid/Spacing"] for row in rows},
                         {"60", "40", "30"})
        for row in rows:
            self.assertGreater(float(row["memory_mb"]), 50)
            self.assertGreater(float(row["wall_seconds"]), 0)
        # the solver makes no difference, the grid does
        heights = [float(row["value"]) for row in rows
                   if row["measure"] == "zmax"]
        self.assertIn("spread", self.table())
        self.assertGreater(max(heights) - min(heights), 1e-3)

    def test_runs_that_fail(self):
        """Without extension and with grid lines that barely cut the tissue,
        no step converges."""
        scene = ROOT / "tests/scenes/without-extension-fails.prm"
        result = self.accuracy(
            scene, "--vary", "Grid/Extension=false,true", "-s",
            "Grid/Extension=true", "--measure", "zmax")
        self.assertIn("Extension = false: left out, it failed with exit "
                      "code 2", result.stdout)
        self.assertIn("| failed |", self.table())
        self.assertEqual(len(self.rows()), 1)

        # without the run that all ladders share, only a file knows the truth
        words = [scene, "--vary", "Grid/Extension=false,true", "--measure",
                 "zmax"]
        self.assertIn("-s", self.accuracy(*words, code=2).stderr)
        reference = self.write("reference.csv", "zmax\n250\n")
        self.accuracy(*words, "--reference", str(reference))
        self.assertEqual(len(self.rows()), 1)


# A disc, half of whose rim is held, that grows.
HELD_DISC = """
set Dimension = 2
subsection Time
  set End time = 2
  set Step = 1
end
subsection Tissue
  set Radius = 120
  set Cell spacing = 8
end
subsection Grid
  set Spacing = 40
  set Offset = 3, 5
end
subsection Growth
  set Law = isotropic
  subsection Isotropic
    set Stretch = 1 + 0.1*t
  end
end
subsection Boundary conditions
  set Fixed where = Y <= 0
end
"""


class Offsets(AccuracyTest):
    def csv(self, name):
        with (self.work / "found" / name).open(encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_scatter_is_that_of_the_runs(self):
        """Every run stands where it says, and the table is made of them."""
        scene = self.write("disc.prm", HELD_DISC)
        measure = ["--measure", "ymax,mean_energy_density"]
        result = self.accuracy(scene, *measure, "--offsets", "4")
        self.assertIn("standard deviation", result.stdout)
        runs = self.csv("offsets.csv")
        self.assertEqual(len(runs), 4 * 2)
        moved = {(row["moved_x"], row["moved_y"]) for row in runs}
        self.assertEqual(moved, {("0", "0"), ("0.5", "0.5"), ("0.75", "0.25"),
                                 ("0.25", "0.75")})
        for row in runs:
            offset = [3 + 40 * float(row["moved_x"]),
                      5 + 40 * float(row["moved_y"])]
            words = ("" if offset == [3, 5]
                     else f"-s Grid/Offset={offset[0]:g},{offset[1]:g}")
            output = self.work / f"by-hand/{offset[0]:g}"
            self.execute(scene, *words.split(), output=output)
            there = read_csv(output / "statistics.csv")[row["measure"]][-1]
            self.assertAlmostEqual(float(row["value"]) / there, 1, places=8)
        for row in self.csv("scatter.csv"):
            values = [float(run["value"]) for run in runs
                      if run["measure"] == row["measure"]]
            self.assertAlmostEqual(float(row["mean"]), statistics.mean(values))
            self.assertAlmostEqual(float(row["standard_deviation"]),
                                   statistics.stdev(values))
            self.assertAlmostEqual(float(row["smallest"]), min(values))
            self.assertAlmostEqual(float(row["largest"]), max(values))
            # and there is something to see
            self.assertGreater(max(values) / min(values), 1.0001)
            self.assertEqual(row["runs"], "4")
        self.assertIn("## Scatter at day 2", self.table())
        self.assertTrue((self.work / "found/offsets.png").is_file())

        # a larger number has the runs of the smaller one
        again = self.accuracy(scene, *measure, "--offsets", "6")
        self.assertEqual(again.stdout.count("from before"), 4)

    def test_method_with_offsets_and_a_reference(self):
        """Beside a ladder and a file of right values: the unsymmetric form
        scatters less, at either spacing the grid is moved by parts of it."""
        scene = self.write("disc.prm", "set Method = paper\n" + HELD_DISC)
        reference = self.write("right.csv", "mean_energy_density\n0.05\n")
        form = "Boundary conditions/Nitsche form"
        penalty = "Boundary conditions/Nitsche penalty"
        self.accuracy(scene, "--vary",
                      f"{form},{penalty}=symmetric:1000,unsymmetric:20",
                      "--vary", "Grid/Spacing=40,60", "--measure", "mean_energy_density",
                      "--offsets", "4", "--reference", str(reference))
        rows = {(row[form], row["Grid/Spacing"]): row
                for row in self.csv("scatter.csv")}
        self.assertEqual(len(rows), 3)
        self.assertLess(float(rows["unsymmetric", "40"]["standard_deviation"]),
                        0.5 * float(rows["symmetric", "40"]
                                    ["standard_deviation"]))
        offsets = {tuple(map(float, line.partition("=")[2].split(",")))
                   for file in (self.work / "found/runs").glob(
                       "*/output/parameters.prm")
                   for line in file.read_text().splitlines()
                   if line.strip().startswith("set Offset")}
        self.assertEqual(offsets, {(3, 5), (23, 25), (33, 15), (13, 35),
                                   (33, 35), (48, 20), (18, 50)})
        self.assertIn("errors, from", self.table())
        self.assertIn("scatter between offsets", self.table())
        self.assertEqual(len(self.rows()), 3)


class Truth(AccuracyTest):
    def test_estimate_of_the_right_value(self):
        """Where the exact solution is known, the limit of the ladders must
        agree with it within the uncertainty that is stated."""
        scene = self.write("graded.prm", GRADED_DISC)
        ladder = ["--vary", "Grid/Spacing,Tissue/Cell spacing="
                  "100:20,70:14,50:10,35:7", "--measure",
                  "surface:mean(radius),total_volume"]
        self.accuracy(scene, *ladder)
        exact = self.exact_radius()
        rows = self.rows()
        for row in rows:
            right = (exact if row["measure"].startswith("surface")
                     else math.pi * exact**2)
            error = abs(float(row["right_value"]) - right)
            stated = float(row["right_value_uncertainty"])
            self.assertLess(error, stated, row["measure"])
            # and no excuse: the radius to 0.2 um, the volume to 3 %
            self.assertLess(stated, 0.2 if row["unit"] == "um"
                            else 0.03 * right, row["measure"])

        reference = self.write("exact.csv", f"r,total_volume\n{exact},"
                               f"{math.pi * exact**2}\n")
        self.accuracy(scene, *ladder, "--reference", str(reference),
                      "--reference-column", "surface:mean(radius)=r",
                      "--wanted", "1%")
        for row in self.rows():
            self.assertAlmostEqual(
                float(row["error"]),
                float(row["value"]) - float(row["right_value"]), places=4)
            self.assertEqual(float(row["right_value_uncertainty"]), 0)
        best = [row for row in self.rows()
                if row["least_time_for_wanted"] == "1"]
        self.assertEqual(len(best), 2)

    @staticmethod
    def exact_radius():
        constants = (0.4 / 1.4 / 0.2, 0.5 / 1.4)  # E = 1 kPa, nu = 0.4
        ball = GrowingBall(
            [Layer(0, 250, lambda R: 1 + 0.4 * R**2 / 250**2,
                   lambda R: 0.8 * R / 250**2)], constants, 2, False)
        return float(250 * ball.stretches([250.0])[1][0])


class Documentation(AccuracyTest):
    def test_short_ladders(self):
        """Ladders of doc/accuracy-and-cost.md, few and coarse: what they
        are to show must show."""
        self.run_words([str(ROOT / "contrib/upkeep/accuracy-ladders"), "--short",
                        "half-fixed-sphere", "grid-offsets",
                        "--morula", self.options.morula, "--output",
                        str(self.work / "found")])
        with (self.work / "found/half-fixed-sphere.short/table.csv").open(
                encoding="utf-8") as stream:
            energy = {row["Grid/Spacing"]: float(row["value"])
                      for row in csv.DictReader(stream)
                      if row["measure"] == "mean_energy_density"}
        # the clamp edge: too stiff a grid stores too much energy
        self.assertGreater(energy["100"], energy["75"])
        # and less with the consistent method, wherever the grid lies
        with (self.work / "found/grid-offsets.short/scatter.csv").open(
                encoding="utf-8") as stream:
            scatter = {(row["measure"], row["Method"]): row
                       for row in csv.DictReader(stream)}
        paper, consistent = (scatter["mean_energy_density", method]
                             for method in ("paper", "consistent"))
        self.assertLess(float(consistent["largest"]), float(paper["smallest"]))


class Columns(AccuracyTest):
    def test_names(self):
        """The names that measures may have are those that Morula writes."""
        scene = self.write("disc.prm", DISC)
        # Only cells of some type have one.
        self.execute(scene, "-s", "Output/Formats=csv",
                     "-s", "Cell types/Names=only")
        output = self.work / "output"
        written = set(read_csv(output / "statistics.csv").dtype.names)
        written.remove("cells_only")
        # Only scenes whose rates look at the state have an error of this kind.
        self.assertEqual(written | {"step_error"},
                         {*columns.STATISTICS, *columns.EFFORT})
        for kind, known in columns.POINTS.items():
            written = set(read_csv(output / f"{kind}-0000.csv").dtype.names)
            self.assertLessEqual(set(known) - {"radius"}, written)

