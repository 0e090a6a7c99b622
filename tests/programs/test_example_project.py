# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/example-project, built out of tree with the installed package as its
README says, line by line, and its results by the closed form.
"""
import math
import re
import shutil

import numpy
from tests.common.program import ProgramTest, read_csv

from tests.common.installation import EXAMPLE, Installation


class ExampleProject(Installation, ProgramTest):
    readme = (EXAMPLE / "README.md").read_text()

    def test_as_its_readme_says(self):
        """Every command of the README, after the installation was moved."""
        blocks = re.findall(r"^```\n(.*?)^```$", self.readme, re.M | re.S)
        install, use = [block.splitlines() for block in blocks]
        self.assertEqual(install[0], "contrib/build morula")  # done by now
        prefix = re.fullmatch(r'cmake --install build --prefix "(\S+)"',
                              install[1])[1]
        self.assertEqual(prefix, "$HOME/morula")
        first = self.install(self.work / "first")
        first.rename(self.home / "morula")

        where, printed, runs = self.home, {}, 0
        for line in use:
            if line.startswith("cd "):
                where = where / line[3:]
                continue
            printed[line] = self.call("bash", "-c", line, cwd=where)
            if re.search(r"my-morula spheroid\.prm$", line):
                self.check_spheroid(where / "output/spheroid")
                shutil.rmtree(where / "output")
                runs += 1
        self.assertEqual(runs, 2, "on one rank and on two")

        keys = printed["build/my-morula --parameters"]
        section = keys.split("  subsection Gompertz\n")[1].split("  end\n")[0]
        for line in ("set Rate = 0.35", "set Decay = 0.5", "Units: 1/day."):
            self.assertIn(line, section)
        explained = printed["build/my-morula spheroid.prm --explain"]
        line, = re.findall(r"^```text\n(.*?)^```$", self.readme, re.M | re.S)
        self.assertIn(line, explained)
        self.check_places(where)
        self.check_refusals(where)

    def check_spheroid(self, output):
        """theta = exp((k/a) (1 - exp(-a t))), without any stress."""
        rows = read_csv(output / "statistics.csv")
        self.assertEqual(rows["time"][-1], 8)
        theta = numpy.exp(0.7 * (1 - numpy.exp(-0.5 * rows["time"])))
        self.assertIn(f"that is {theta[-1]:.3f}, ", self.readme)
        self.assertIn(f"has {theta[-1]**3:.3f} times", self.readme)
        for column in ("total_volume", "grown_volume"):
            numpy.testing.assert_allclose(
                rows[column] / rows[column][0], theta**3, rtol=1e-5)
        for column in ("zmax", "zmin"):
            numpy.testing.assert_allclose(
                rows[column] / rows[column][0], theta, rtol=1e-4)
        self.assertLess(rows["max_energy_density"].max(), 1e-8)

    def check_places(self, where):
        """The README's rate by place, and a decay of its own; each cell."""
        rate, = re.findall(r'-s "Growth/Gompertz/Rate=([^"]+)"', self.readme)
        output = self.work / "places"
        for ranks in (1, 2):
            self.call(self.options.mpiexec, "-n", ranks,
                      "build/my-morula", "spheroid.prm",
                      "-s", f"Growth/Gompertz/Rate={rate}",
                      "-s", "Growth/Gompertz/Decay=2",
                      "-s", "Time/End time=0.5", "-s", "Time/Step=0.25",
                      "-s", "Output/Formats=csv",
                      "-s", f"Output directory={output}", cwd=where)
            cells = read_csv(sorted(output.glob("cells-*.csv"))[-1])
            radius = numpy.sqrt(cells["X"]**2 + cells["Y"]**2 + cells["Z"]**2)
            k = 0.35 * (radius / 100)**2
            numpy.testing.assert_allclose(
                cells["growth_volume_ratio"],
                numpy.exp(3 * k / 2 * (1 - math.exp(-2 * 0.5))), rtol=1e-9)
            # The core is pulled outwards, and the rim is squeezed.
            elastic = cells["elastic_volume_ratio"]
            self.assertGreater(elastic[radius < 50].min(), 1.001)
            self.assertLess(elastic[radius > 90].max(), 0.999)

    def check_refusals(self, where):
        for key, value, remedy in (
                ("Growth/Gompertz/Decay", "-1", "a number >= 0"),
                ("Growth/Gompertz/Decay", "fast", "a"),
                ("Growth/Gompertz/Rate", "0.35 *", "expression"),
                ("Growth/Gompertz/Decya", "1", "Growth/Gompertz/Decay"),
                ("Growth/Law", "gomperz", "gompertz")):
            text = self.call("build/my-morula", "spheroid.prm",
                             "-s", f"{key}={value}", cwd=where, code=1)
            for part in (key, value, remedy):
                self.assertIn(part, text)
        # morula itself says that it does not know the law.
        text = self.call(self.home / "morula/bin/morula", "spheroid.prm",
                         cwd=where, code=1)
        self.assertIn("'gompertz'", text)
        self.assertFalse((where / "output").exists())

