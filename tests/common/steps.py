# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the step programs."""
from pathlib import Path

from upkeep.step_tables import tables

from tests.common.program import ProgramTest, overrides, read_csv

ROOT = Path(__file__).resolve().parents[2]


class StepTest(ProgramTest):
    """A test of one step program, on the number of ranks of the command."""

    def step(self, *arguments, code=0, output=None, prm=None):
        """Runs the step with its own .prm file, and returns what it printed."""
        prm = prm or ROOT / f"prm/{Path(self.options.morula).name}.prm"
        result = self.execute(prm, *arguments, ranks=self.options.ranks,
                              output=output, code=code)
        return result.stderr if code else result.stdout

    def assert_near(self, values, expected, relative=0.0, absolute=0.0):
        self.assertEqual(len(values), len(expected), values)
        for value, wanted in zip(values, expected):
            self.assertLessEqual(abs(value - wanted),
                                 relative * abs(wanted) + absolute,
                                 f"{values}, expected {expected}")
