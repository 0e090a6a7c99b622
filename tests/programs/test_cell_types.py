# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells with types: the same events on any number of ranks and after a resumption,
and what a rate that becomes wrong in mid-run does."""
import csv
import math

from tests.common.program import (SCENES, ProgramTest, overrides, read_csv
                     without_wall_time)

SCENE = SCENES / "cell-types.prm"
# Rates that do not depend on what the solver leaves in the last digits.
EXACT = overrides({
    "Cell types/transit/Transitions/To resting": "0.8 + 0.2*hill(age, 1, 2)",
    "Time/End time": "1.5"})
RATE = "Cell types/transit/Transitions/To resting"
TABLES = "lineage.csv", "events.csv"

# A slab in plane strain that is stretched by a tenth in a frame of the same shape,
# becomes three times as stiff in the third step, and is stretched further.
STIFFENING = """
set Dimension = 2
set Method    = paper
subsection Time
  set End time = 0.4
  set Step     = 0.1
end
subsection Tissue
  set Shape        = box
  set Size         = 80, 40
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 20
end
subsection Material
  set Energy per = grown volume
end
subsection Cell types
  set Names = soft, hard
  subsection soft
    subsection Transitions
      set To hard = 1e4*(t > 0.22)
    end
  end
  subsection hard
    subsection Material
      set Young's modulus = 3
    end
  end
end
subsection Boundary conditions
  set Fixed where  = 1
  set Displacement = (0.1*min(t/0.1, 1) + 0.05*(t > 0.35))*X; 0
end
subsection Solver
  set Newton tolerance = 1e-8
end
subsection Output
  set Formats  = csv
  set Interval = 0.1
end
"""


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


class CellTypes(ProgramTest):
    def test_ranks(self):
        one = self.work / "ranks-1"
        self.execute(SCENE, *EXACT, output=one)
        events = rows(one / "events.csv")
        self.assertGreater(len(events), 20)
        self.assertEqual({event["event"] for event in events}, {"transition"})
        births = [(birth["id"], birth["parent"], birth["birth_time"], birth["type"])
                  for birth in rows(one / "lineage.csv")]
        for ranks in (2, 4):
            output = self.work / f"ranks-{ranks}"
            self.execute(SCENE, *EXACT, ranks=ranks, output=output)
            self.assert_same_file(one / "events.csv", output / "events.csv")
            self.assertEqual(births, [
                (birth["id"], birth["parent"], birth["birth_time"], birth["type"])
                for birth in rows(output / "lineage.csv")])

    def test_numbers_add_up(self):
        output = self.work / "output"
        self.execute(SCENE, *EXACT, output=output)
        counts = {"transit": 0, "stem": 0, "resting": 0}
        names = list(counts)
        last = rows(output / "statistics.csv")[-1]
        mothers = {birth["parent"] for birth in rows(output / "lineage.csv")}
        kinds = {birth["id"]: names[int(birth["type"])]
                 for birth in rows(output / "lineage.csv")}
        for event in rows(output / "events.csv"):
            self.assertEqual(kinds[event["id"]], event["from"])
            kinds[event["id"]] = event["to"]
        for cell, kind in kinds.items():
            counts[kind] += cell not in mothers
        self.assertEqual(
            counts, {name: int(last["cells_" + name]) for name in names})
        self.assertEqual(sum(counts.values()), int(last["cells"]))

    def test_resumed(self):
        for ranks in (1, 2):
            whole = self.work / f"whole-{ranks}"
            resumed = self.work / f"resumed-{ranks}"
            step = overrides({"Time/Step": "0.125"})  # times are exact
            self.execute(SCENE, *step, ranks=ranks, output=whole)
            self.execute(SCENE, *step, "-s", "Time/End time=0.75", ranks=ranks,
                         output=resumed)
            self.execute(SCENE, *step, "--resume", ranks=ranks, output=resumed)
            self.assertEqual(without_wall_time(whole), without_wall_time(resumed))
            for table in TABLES:
                self.assert_same_file(whole / table, resumed / table)

    def test_stress_at_a_transition(self):
        """A cell keeps its strain, so that its stress grows with the stiffness, or
        forgets its stress: then only what comes afterwards stretches it."""
        lame_lambda, mu = 0.4 / 1.4 / 0.2, 1 / 2.8  # E = 1 kPa, nu = 0.4

        def stress(stretch, E):
            return E * (mu * (stretch**2 - 1)
                        + lame_lambda * math.log(stretch)) / stretch
        scene = self.write("slab.prm", STIFFENING)
        for choice, after, later in (
                ("keep strain", stress(1.1, 3), stress(1.15, 3)),
                ("forget stress", 0, stress(1.15 / 1.1, 3))):
            output = self.work / choice
            self.execute(scene, *overrides({"Material/On transition": choice}),
                         output=output)
            means = [read_csv(output / f"cells-{n:04d}.csv")["sigma_xx"].mean()
                     for n in (1, 3, 4)]
            print(choice, "sigma_xx, kPa:", means)
            for mean, exact in zip(means, (stress(1.1, 1), after, later)):
                self.assertLess(abs(mean - exact), 1e-3 * stress(1.1, 1))

    def test_wrong_in_mid_run(self):
        output = self.work / "output"
        said = self.execute(SCENE, "-s", f"{RATE}=0.5 - t", output=output, code=2)
        for part in (RATE, "'0.5 - t'", ">= 0", "0 lets cells keep their type",
                     "snapshot.h5"):
            self.assertIn(part, said.text)
        self.assertTrue((output / "snapshot.h5").exists())
        said = self.execute(SCENE, "-s", f"{RATE}=-0.5 - t",
                            output=self.work / "refused", code=1)
        self.assertIn(RATE, said.text)
        self.assertFalse((self.work / "refused").exists())

    def test_friction_wrong_in_mid_run(self):
        output = self.work / "output"
        said = self.execute(SCENE, "-s", "Friction/Coefficient=1e-6*volume*sqrt(0.3-t)",
                            output=output, code=2)
        for part in ("Friction/Coefficient", "allowed is a finite value", "t = 0.",
                     "snapshot.h5"):
            self.assertIn(part, said.text)
        self.assertTrue((output / "snapshot.h5").exists())

    def test_absent(self):
        output = self.work / "output"
        self.execute(SCENES / "proliferating-disc.prm", "-s", "Time/End time=0.1",
                     output=output)
        self.assertFalse((output / "events.csv").exists())
        self.assertNotIn("type", (output / "lineage.csv").read_text())
        self.assertNotIn(",cells_", (output / "statistics.csv").read_text())

