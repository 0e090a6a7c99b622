# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 7: an added law and an added rule, by closed forms and by the contract."""
import math
import re

import numpy
from tests.common.steps import ROOT, StepTest, overrides, read_csv

RULE = "Proliferation/Cell cycle/Division axis"
LAW = "Growth/Crowding limited/"
MEMORY = "Proliferation/Cell cycle/Long axis/Memory"

# A rigid box: all of its surface is held, and all cells grow alike. So F = I.
BOX = {"Tissue/Size": "100, 100",
       "Boundary conditions/Nitsche form": "symmetric",
       "Boundary conditions/Nitsche penalty": "1e3",
       "Boundary conditions/Fixed where": "1",
       "Boundary conditions/Displacement": "0; 0; 0",
       "Proliferation/Law": "none", RULE: "random",
       LAW + "Rate": "0.5", "Time/End time": "2", "Output/Formats": "none"}

SHORT = {"Tissue/Cell spacing": "20", "Grid/Spacing": "50",
         "Time/End time": "1", "Time/Step": "0.1",
         "Output/Interval": "0", "Output/Formats": "csv"}


class Step7(StepTest):
    def elastic_volume(self, step, time):
        """J at a time, the same in all cells."""
        self.step(*overrides({**BOX, "Time/Step": step,
                              "Time/End time": time}))
        row = read_csv(self.work / "output/statistics.csv")[-1]
        self.assertEqual(row["time"], time)
        self.assertAlmostEqual(row["min_elastic_volume_ratio"],
                               row["max_elastic_volume_ratio"], delta=1e-8)
        return row["min_elastic_volume_ratio"]

    def test_rigid_box(self):
        """J = 1/det F_g obeys dJ/dt = -(2 k/c) J (J - (1-c)), a logistic
        equation; the law is first order in the time step."""
        def exact(t):
            return a / (1 - (1 - a) * math.exp(-2 * k * a / (1 - a) * t))

        a, k = 0.8, 0.5
        errors = [abs(self.elastic_volume(step, 0.2) - exact(0.2))
                  for step in (0.05, 0.025, 0.0125)]
        self.assertLess(errors[-1], 0.0025)
        for coarse, fine in zip(errors, errors[1:]):
            self.assertAlmostEqual(coarse / fine, 2, delta=0.2)
        # It comes to rest at 1 - c.
        self.assertAlmostEqual(self.elastic_volume(0.1, 2), a, delta=1e-4)

    def daughters(self, rule, **keys):
        """|cos| of the angles between daughters' distances and the x axis."""
        self.step(*overrides({**SHORT, RULE: rule, **keys}))
        lineage = read_csv(self.work / "output/lineage.csv")
        born = lineage[lineage["parent"] >= 0]
        first, second = born[0::2], born[1::2]
        # Cells that entered S before the pull could be felt take any axis.
        late = first["birth_time"] > 0.75
        first, second = first[late], second[late]
        self.assertGreater(len(first), 30)
        numpy.testing.assert_array_equal(first["parent"], second["parent"])
        x = first["x"] - second["x"]
        return abs(x) / numpy.hypot(x, first["y"] - second["y"])

    def test_division_rule(self):
        """The strip is pulled along x: so are its cells, and their daughters
        lie side by side; by random axes the mean is 2/pi."""
        self.assertGreater(self.daughters("long axis").mean(), 0.95)
        self.assertAlmostEqual(self.daughters("random").mean(), 2 / math.pi,
                               delta=0.1)

    def test_memory(self):
        """Who forgets within a step of a tenth of a day divides along the pull;
        who remembers 1000 days, in which nothing was stretched, does not know
        of it."""
        self.assertGreater(
            self.daughters("long axis", **{MEMORY: "0.05"}).mean(), 0.95)
        self.assertAlmostEqual(
            self.daughters("long axis", **{MEMORY: "1000"}).mean(),
            2 / math.pi, delta=0.1)

    def test_resume(self):
        whole, resumed = self.work / "whole", self.work / "resumed"
        scene = {**SHORT, MEMORY: "0.2"}
        self.step(*overrides(scene), output=whole)
        self.step(*overrides({**scene, "Time/End time": "0.5"}),
                  output=resumed)
        message = self.step(*overrides({**scene, LAW + "Rate": "0.06"}),
                            "--resume", output=resumed, code=1)
        self.assertIn(LAW + "Rate", message)
        self.step(*overrides(scene), "--resume", output=resumed)
        self.assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")
        names = [sorted(path.glob("cells-*.csv"))[-1]
                 for path in (whole, resumed)]
        self.assert_same_columns(*names)
        keys = (whole / "parameters.prm").read_text()
        self.assertRegex(keys, r"set Law += crowding limited")
        self.assertRegex(keys, r"subsection Long axis")

    def test_contract(self):
        keys = self.run_words([self.options.morula, "--parameters"]).stdout
        for line in ("subsection Crowding limited", "set Crowding = 0.2",
                     "subsection Long axis", "set Least elongation = 1.02"):
            self.assertIn(line, keys)
        text = self.step("--explain")
        self.assertIn("crowding limited, Rate = 0.1, Crowding = 0.2", text)
        self.assertIn("axis = long axis, Least elongation = 1.02", text)
        page = (ROOT / "doc/steps/step-7.md").read_text()
        for line in re.findall(r"^  (?:growth|division) .* on .*$", page, re.M):
            self.assertIn(line, text)
        for key, value in ((LAW + "Crowding", "0"), (LAW + "Crowding", "1"),
                           (LAW + "Rate", "1 +"),
                           (RULE[:-13] + "Long axis/Least elongation", "0.5"),
                           ("Growth/Law", "crowding")):
            message = self.step("-s", f"{key}={value}", code=1)
            self.assertIn(key, message)
        # Its expressions are asked before any work: Z is unknown in 2-D.
        message = self.step("-s", f"{LAW}Rate=0.1 + Z", code=1)
        self.assertIn("an expression without Z in 2-D", message)
        self.assertFalse((self.work / "output").exists())

    def test_forgotten(self):
        """Values of an effect that nothing switches on."""
        scene = self.write("forgotten.prm",
                           "subsection Growth\nsubsection Crowding limited\n"
                           "set Rate = 2\nend\nend\n")
        message = self.step(prm=scene, code=1)
        self.assertIn("Growth/Law = crowding limited", message)

    def test_morula_does_not_know(self):
        morula = ROOT / self.options.morula
        morula = morula.with_name("morula")
        result = self.run_words([morula, ROOT / "prm/step-7.prm"], 1)
        self.assertIn("crowding limited", result.stderr)

