# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The key Method: what a run does with it, writes of it, and resumes with it;
and that the tools complete a scene as the program does.
"""
from pathlib import Path

from morula.prm import parse
from morula.program import Program
from morula.scene import normal
from tests.common.program import ProgramTest, overrides, read_csv, without_wall_time

ROOT = Path(__file__).resolve().parents[2]

FORM = "Boundary conditions/Nitsche form"
PENALTY = "Boundary conditions/Nitsche penalty"

# A disc, half of whose rim is held, that grows.
DISC = """
set Dimension = 2
subsection Time
  set End time = 2
  set Step = 1
end
subsection Tissue
  set Radius = 100
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 40
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
subsection Output
  set Interval = 0
end
"""


class MethodTest(ProgramTest):
    def run_disc(self, name, *arguments, code=0, **keys):
        """A run of the disc in a directory of this name."""
        output = self.work / name
        self.execute(self.write("disc.prm", DISC), *arguments,
                     *overrides(keys), output=output, code=code)
        return output

    def test_it_is_the_word_for_its_keys(self):
        consistent = self.run_disc("silent")
        for name, keys in (("consistent", {"Method": "consistent"}),
                           ("spelt", {FORM: "bounded", PENALTY: "20"})):
            self.assertEqual(without_wall_time(consistent),
                             without_wall_time(self.run_disc(name, **keys)))
        paper = self.run_disc("paper", Method="paper")
        self.assertEqual(
            without_wall_time(paper),
            without_wall_time(self.run_disc("spelt-paper",
                                            **{FORM: "symmetric",
                                               PENALTY: "1000"})))
        energies = [read_csv(output / "statistics.csv")["mean_energy_density"]
                    [-1] for output in (paper, consistent)]
        self.assertGreater(energies[0], 1.03 * energies[1])

    def test_parameters_run_again_to_the_same(self):
        first = self.run_disc("first", Method="consistent", **{PENALTY: "35"})
        keys = parse((first / "parameters.prm").read_text())
        self.assertEqual((keys["Method"], keys[FORM], normal(keys[PENALTY])),
                         ("consistent", "bounded", "35"))
        again = self.work / "again"
        self.execute(first / "parameters.prm", output=again)
        self.assertEqual(without_wall_time(first), without_wall_time(again))

    def test_resuming_asks_for_the_values_not_the_word(self):
        spelt = {FORM: "bounded", PENALTY: "20"}
        whole = self.run_disc("whole", **spelt)
        halves = self.run_disc("halves", **{**spelt, "Time/End time": "1"})
        self.run_disc("halves", "--resume", Method="consistent")
        self.assertEqual(without_wall_time(whole), without_wall_time(halves))

        # a scene of before this key goes on as the paper's
        older = self.run_disc("older", **{"Time/End time": "1",
                                          FORM: "symmetric", PENALTY: "1000"})
        error = self.execute(self.work / "disc.prm", "--resume", "-s",
                             "Method=consistent", output=older, code=1).stderr
        self.assertIn("Nitsche", error)
        self.assertIn("as in the snapshot", error)
        self.run_disc("older", "--resume", Method="paper")

    def test_explain_lists_its_keys(self):
        text = self.execute(self.write("disc.prm", DISC), "--explain", "-s",
                            "Method=consistent", "-s", f"{PENALTY}=35").stdout
        self.assertIn("Method\n  consistent, which stands for\n", text)
        self.assertIn(f"    {PENALTY} = 35 (set by the scene)\n", text)
        self.assertIn(f"    {FORM} = bounded\n", text)

    def test_tools_complete_a_scene_alike(self):
        for number, chosen in enumerate((
                {}, {"Method": "paper"}, {"Method": "consistent"},
                {"Method": "consistent", FORM: "symmetric"})):
            output = self.run_disc(f"keys-{number}", **chosen,
                                   **{"Time/End time": "1"})
            written = parse((output / "parameters.prm").read_text())
            expected = Program(self.options.morula).complete(
                {**parse(DISC), **chosen, "Time/End time": "1",
                 "Output directory": str(output)})
            self.assertEqual({key: normal(value)
                              for key, value in written.items()},
                             {key: normal(value)
                              for key, value in expected.items()})

