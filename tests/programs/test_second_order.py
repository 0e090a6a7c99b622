# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is of second order in the step, and what a run says of its error in time:
doc/theory.md, section 5.11."""
import numpy as np
from morula.error_in_time import error_in_time
from morula.run import Run
from tests.common.program import TESTS, ProgramTest, overrides, without_wall_time

EXAMPLES = TESTS.parent / "prm/examples"
PAPER = TESTS.parent / "prm/paper"

QUIET = {"Output/Formats": "csv", "Output/Interval": "0"}

SHEET = """
set Dimension = 2
subsection Time
  set End time = 1.5
end
subsection Tissue
  set Shape        = box
  set Size         = 100, 100
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 25
end
"""
WAITING = {"Proliferation/Law": "cell cycle",
           "Proliferation/Cell cycle/Duration": "1",
           "Proliferation/Cell cycle/G0 exit rate": "200*(t > 0.5)"}

STRIP = """
set Dimension = 2
subsection Time
  set End time = 1
  set Step     = 0.1
end
subsection Tissue
  set Shape        = box
  set Size         = 200, 40
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 20
end
"""

# A nest that grows as its stress and a gradient let it, flows, and feeds; half of
# its cells change their type by stress.
NEST = """
set Dimension = 2
subsection Time
  set End time = 0.8
  set Step     = 0.1
end
subsection Tissue
  set Shape        = sphere
  set Radius       = 60
  set Cell spacing = 8
end
subsection Grid
  set Spacing = 25
end
subsection Material
  set Young's modulus = 1 + (type == leaf)
  set Energy per      = grown volume
  set Relaxation time = 0.2
end
subsection Fields
  set Names = food
  subsection food
    set Diffusion   = 2000
    set Consumption = 2
    set Fixed where = 1
    set Value       = 1
    set Initial     = 1
  end
end
subsection Cell types
  set Names = stem, leaf
  subsection stem
    subsection Transitions
      set To leaf = 3*max(0, pressure) + food
    end
  end
end
subsection Growth
  set Law = rate
  subsection Rate
    set Rate        = 0.8*food*max(0, 1 - pressure)
    set Direction   = gradient of food
    set Share along = 0.6
    set Homeostasis = 0.2
  end
end
subsection Proliferation
  set Law = cell cycle
  subsection Cell cycle
    set Duration        = 0.4
    set G0 exit rate    = 2*food
    set Size checkpoint = 0.98
  end
end
subsection Death
  set Rate           = 0.3*max(0, 1 - food)
  set Shrinking time = 0.2*(abs(x) > 6 || t < 0.5)
  set When           = abs(x) < 6 && t >= 0.5
end
"""


class SecondOrder(ProgramTest):
    def run_scene(self, scene, keys=None, *arguments, name="output", **more):
        output = self.work / name
        process = self.execute(scene, *overrides({**QUIET, **(keys or {})}),
                               *arguments, output=output, **more)
        return Run(output), process

    def test_wait_with_time(self):
        """A rate of leaving G0 has the time of the middle of a step."""
        sheet = self.write("sheet.prm", SHEET)
        # It jumps at day 0.5; cells divide half a day after their onset.
        for step in (0.25, 0.125):
            run, _ = self.run_scene(sheet, {**WAITING, "Time/Step": step},
                                    name=f"jump-{step}")
            births = run.lineage.table["birth_time"]
            self.assertAlmostEqual(births[births > 0].min(), 1, delta=1e-3)
        # Divided until 1.4, with T = 0.4: 1 - exp(-H(1.2)), H = 0.5 t + 0.4 t².
        exact = 1 - np.exp(-0.5 * 1.2 - 0.4 * 1.2**2)
        parts = []
        for step in (0.2, 0.1, 0.05):
            run, _ = self.run_scene(sheet, {
                **WAITING, "Time/Step": step, "Time/End time": "1.4",
                "Proliferation/Cell cycle/Duration": "0.4",
                "Proliferation/Cell cycle/G0 exit rate":
                    "(0.5 + 0.8*t)*(generation == 0)"}, name=f"{step}")
            parts.append(run.statistics["dividing"].sum() / 400)
        print("divided:", parts, "exact:", exact)
        # 400 cells draw the same numbers: chance is common to all steps.
        self.assertLess(np.ptp(parts), 0.004)
        self.assertAlmostEqual(parts[-1], exact,
                               delta=2 * np.sqrt(exact * (1 - exact) / 400))

    def test_order_of_fields(self):
        """a becomes b, or each the other: nothing is lost, in any order."""
        strip = self.write("strip.prm", STRIP)
        both = {}
        for names in ("a, b", "b, a"):
            for back in (0, 1):
                keys = {"Fields/Names": names,
                        "Fields/a/Time": "transient",
                        "Fields/a/Diffusion": "100",
                        "Fields/a/Consumption": "2",
                        "Fields/a/Initial": "5",
                        "Fields/a/Production": f"{back}*b" if back else "0",
                        "Fields/b/Time": "transient",
                        "Fields/b/Diffusion": "100",
                        "Fields/b/Consumption": back,
                        "Fields/b/Production": "2*a"}
                run, _ = self.run_scene(strip, keys,
                                        name=f"{names[0]}{back}")
                last = run.statistics.iloc[-1]
                both[names, back] = last["a_mean"]
                self.assertAlmostEqual(last["a_mean"] + last["b_mean"], 5,
                                       places=7)
                # Implicit Euler of a' = -2 a + back (5 - a).
                rest = 5 * back / (2 + back)
                self.assertAlmostEqual(
                    last["a_mean"],
                    rest + (5 - rest) * (1 + 0.1 * (2 + back))**-10, places=6)
        self.assertAlmostEqual(both["a, b", 1], both["b, a", 1], places=7)

    def test_growth_under_stress(self):
        """The surface's way at the scene's own step is that of short ones."""
        ways, errors = {}, {}
        for step in (0.4, 0.2, 0.05):
            run, process = self.run_scene(
                EXAMPLES / "growth-under-stress.prm",
                {"Time/End time": "2", "Time/Step": step}, name=f"{step}")
            table = run.statistics
            ways[step] = (table["total_volume"].iloc[-1]
                          - table["total_volume"].iloc[0])
            errors[step] = error_in_time(table)
            self.assertIn("error in time", process.text)
        print("growth, um^3:", ways, "estimates:", errors)
        self.assertLess(abs(ways[0.2] / ways[0.05] - 1), 5e-3)
        # What it says falls with the step, and is of the error's order.
        self.assertGreater(errors[0.4], 2 * errors[0.2])
        self.assertGreater(errors[0.2], 4 * errors[0.05])

    def test_drop_in_steps_of_its_relaxation_time(self):
        ways = {}
        for step in (0.1, 0.02):
            run, _ = self.run_scene(
                EXAMPLES / "rounding-drop.prm",
                {"Time/End time": "0.8", "Time/Step": step}, name=f"{step}")
            x = run.statistics["xmax"]
            ways[step] = x.iloc[0] - x.iloc[-1]
        print("way of the tip, um:", ways)
        self.assertLess(abs(ways[0.1] / ways[0.02] - 1), 0.02)

    def test_a_cut_opens_when_it_is_due(self):
        """At the end of the step that ends at day 1: the first equilibrium with
        the cut is that of the next step."""
        run, _ = self.run_scene(EXAMPLES / "cut-and-opening.prm", {
            "Tissue/Cell spacing": "10", "Grid/Spacing": "40",
            "Tissue/Radius": "200",
            "Death/When": "t >= 1 && X > 0 && abs(Y) < 30"})
        table = run.statistics
        row = int(np.flatnonzero(table["removed"] > 0)[0])
        self.assertAlmostEqual(table["time"][row], 1)
        self.assertEqual({*run.events["time"]}, {1.0})
        energy = table["mean_energy_density"]
        self.assertLess(energy[row + 1], 0.7 * energy[row])

    def test_the_same_on_ranks_and_resumed(self):
        """With every column that steps compare, and steps that choose their
        length."""
        nest = self.write("nest.prm", NEST)
        for tolerance in (0, 2e-3):
            keys = {"Time/Tolerance": tolerance, "Output/Interval": "0.4",
                    "Solver/Newton tolerance": "1e-11"}
            one, _ = self.run_scene(nest, keys, name=f"1-{tolerance}")
            table = one.statistics
            self.assertGreater(table["step_error"].max(), 0)
            self.assertGreater(table["dividing"].sum(), 20)
            self.assertGreater(table["deaths"].sum(), 5)
            self.assertGreater(one.statistics["cells_leaf"].iloc[-1], 20)
            if tolerance:
                self.assertLess(table["dt"][1], 0.1 / 8)
                self.assertGreater(len({*np.round(table["dt"][1:], 9)}), 2)
                cut = int(np.flatnonzero(table["removed"] > 3)[0])
                self.assertLess(table["dt"][cut + 1], 0.1 / 8)
            for ranks in (2, 3):
                several, _ = self.run_scene(
                    nest, keys, name=f"{ranks}-{tolerance}", ranks=ranks)
                for name in ("cells", "dividing", "deaths", "cells_leaf"):
                    np.testing.assert_array_equal(table[name],
                                                  several.statistics[name])
                for name in ("dt", "total_volume", "grown_volume"):
                    np.testing.assert_allclose(table[name],
                                               several.statistics[name],
                                               rtol=1e-9)
            self.run_scene(nest, {**keys, "Time/End time": "0.4"},
                           name=f"parts-{tolerance}")
            self.run_scene(nest, keys, "--resume", name=f"parts-{tolerance}")
            whole = self.work / f"1-{tolerance}"
            parts = self.work / f"parts-{tolerance}"
            self.assertEqual(without_wall_time(whole),
                             without_wall_time(parts))
            for name in ("events.csv", "lineage.csv"):
                self.assert_same_file(whole / name, parts / name)

    def test_nothing_is_kept_where_only_time_matters(self):
        """No column of statistics.csv, no word on an error in time."""
        sheet = self.write("sheet.prm", SHEET)
        run, process = self.run_scene(sheet, {
            "Growth/Law": "rate", "Growth/Rate/Rate": "0.3*t",
            "Time/Step": "0.25"})
        self.assertNotIn("step_error", run.statistics.columns)
        self.assertNotIn("error in time", process.text)
        self.assertIsNone(error_in_time(run.statistics))

