# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the step programs, and the tables that they print."""
import argparse
import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

sys.path.insert(0, str(ROOT / "tests/programs"))
# flake8: noqa: E402, F401 (also for the tests that import them)
from program import ProgramTest, overrides, read_csv


def tables(text):
    """The tables of deal.II's TableHandler::org_mode_table in a text, each a
    dictionary: column -> list of numbers (NaN for '-', text as it is). A column
    of rates has the name of the one before it with ' rate', the second column of
    a name has a ' 2' behind it."""
    found, lines = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            lines.append([word.strip() for word in line.split("|")[1:-1]])
        elif lines:
            names = [name if "...red.rate" not in name
                     else lines[0][i - 1] + " rate"
                     for i, name in enumerate(lines[0])]
            names = [f"{name} 2" if name in names[:i] else name
                     for i, name in enumerate(names)]
            found.append({name: [number(line[i]) for line in lines[1:]]
                          for i, name in enumerate(names)})
            lines = []
    return found


def number(word):
    if word == "-":
        return float("nan")
    try:
        return float(word)
    except ValueError:
        return word


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
