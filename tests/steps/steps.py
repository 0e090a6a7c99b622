# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the step programs."""
import argparse
import os
import sys
import tempfile
import unittest
from pathlib import Path

from upkeep.step_tables import tables

from tests.programs.program import ProgramTest, overrides, read_csv

ROOT = Path(__file__).resolve().parents[2]


class StepTest(ProgramTest):
    """A test of one step program, on the number of ranks of the command."""

    def step(self, *arguments, code=0, output=None, prm=None):
        """Runs the step with its own .prm file, and returns what it printed."""
        prm = prm or ROOT / f"prm/{self.options.step}.prm"
        result = self.execute(prm, *arguments, ranks=self.options.ranks,
                              output=output, code=code)
        return result.stderr if code else result.stdout

    def assert_near(self, values, expected, relative=0.0, absolute=0.0):
        self.assertEqual(len(values), len(expected), values)
        for value, wanted in zip(values, expected):
            self.assertLessEqual(abs(value - wanted),
                                 relative * abs(wanted) + absolute,
                                 f"{values}, expected {expected}")


def main():
    """Runs the tests of the calling file, tests/steps/step_N.py."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True, help="build/step-N")
    parser.add_argument("--mpiexec", default="mpiexec")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--work", type=Path, help="directory for the runs")
    options, rest = parser.parse_known_args()
    options.morula = os.path.abspath(options.program)
    options.step = Path(options.program).name
    with tempfile.TemporaryDirectory() as temporary:
        options.work = (options.work or Path(temporary)).resolve()
        ProgramTest.options = options
        unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
