# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program for tests that take several of them."""
import argparse
import csv
import os
import shlex
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

from morula.execute import command, overrides

from tests.common import forks
from tests.common.results import read_csv

TESTS = Path(__file__).resolve().parents[1]
SCENES = TESTS / "scenes"


def without_wall_time(run):
    """The rows of a run's statistics.csv without the column that differs from
    one run to the next."""
    with open(run / "statistics.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    column = rows[0].index("wall_seconds")
    return [row[:column] + row[column + 1:] for row in rows]


class ProgramTest(unittest.TestCase):
    """A test with the program and an empty directory of its own."""

    options = None
    maxDiff = None

    def setUp(self):
        self.work = self.options.work / self.id().split(".", 1)[-1]
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir(parents=True)

    def command(self, scene, *arguments, ranks=1):
        return command(self.options.morula, scene, *arguments, ranks=ranks,
                       mpiexec=self.options.mpiexec)

    def execute(self, scene, *arguments, ranks=1, output=None, code=0):
        """Runs a scene, by default into work/output, and returns the process
        with what it printed; the test fails on another exit code."""
        output = output or self.work / "output"
        words = self.command(scene, "-s", f"Output directory={output}",
                             *arguments, ranks=ranks)
        return self.run_words(words, code)

    def run_words(self, words, code=0, cwd=SCENES, call=forks.call):
        result = call(words, cwd=cwd)
        if result.code != code:
            self.fail(f"exit code {result.code}, expected {code}\n"
                      f"+ {shlex.join(map(str, words))}\n{result.text}")
        return result

    def write(self, name, text):
        """A file in the test's own directory."""
        path = self.work / name
        path.write_text(text)
        return path

    def assert_same_file(self, a, b):
        if Path(a).read_bytes() != Path(b).read_bytes():
            self.fail(f"{a} and {b} differ")

    def assert_same_columns(self, a, b, tolerances=None, ignore=()):
        """Two CSV files with the same rows, but for the columns named."""
        tolerances = tolerances or {}
        one, other = read_csv(a), read_csv(b)
        self.assertEqual(one.dtype.names, other.dtype.names)
        self.assertEqual(len(one), len(other), f"rows of {a} and {b}")
        for name in one.dtype.names:
            if name in ignore:
                continue
            difference = abs(one[name] - other[name]).max()
            self.assertLessEqual(difference, tolerances.get(name, 0.0),
                                 f"column {name} of {a} and {b}")


def main():
    """Runs the tests of the calling file."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--morula", required=True, help="the executable")
    parser.add_argument("--mpiexec", default="mpiexec")
    parser.add_argument("--work", type=Path, help="directory for the runs")
    options, rest = parser.parse_known_args()
    options.morula = os.path.abspath(options.morula)
    with tempfile.TemporaryDirectory() as temporary:
        options.work = (options.work or Path(temporary)).resolve()
        ProgramTest.options = options
        unittest.main(argv=[sys.argv[0], *rest], verbosity=2)
