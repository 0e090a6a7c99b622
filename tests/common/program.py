# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program, for the tests in Python."""
import csv
import shlex
import shutil
import unittest
from pathlib import Path

from morula.execute import command, overrides
from morula.run import Run

from tests.common import forks
from tests.common.results import read_csv

TESTS = Path(__file__).resolve().parents[1]
ROOT = TESTS.parent
SCENES = TESTS / "scenes"


def without_wall_time(run):
    """The rows of a run's statistics.csv without the column that differs from
    one run to the next."""
    with open(run / "statistics.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    column = rows[0].index("wall_seconds")
    return [row[:column] + row[column + 1:] for row in rows]


def empty_directory(options, test):
    """That of a test or a module, by its name with dots."""
    work = options.work / test.removeprefix("tests.").replace(".test_", "/", 1)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    return work


class Calls:
    """Runs of the program with the options of the command line, in a directory
    `work`."""

    def command(self, scene, *arguments, ranks=1):
        return command(self.options.morula, scene, *arguments, ranks=ranks,
                       mpiexec=self.options.mpiexec)

    def execute(self, scene, *arguments, ranks=1, output=None, code=0):
        """Runs a scene, by default into work/output, and returns the process
        with what it printed; the test fails on another exit code."""
        output = output or self.work / "output"
        words = self.command(scene, "-s", f"Output directory={output}",
                             *arguments, ranks=ranks)
        return self.call(words, code)

    def call(self, words, code=0, cwd=SCENES, call=forks.call):
        result = call(words, cwd=cwd)
        assert result.code == code, (f"exit code {result.code}, expected {code}\n"
                                     f"+ {shlex.join(map(str, words))}\n{result.text}")
        return result

    def run(self, name, scene, keys=(), **options):
        """Runs a scene, a file or its text, with these keys, into work/NAME, and
        returns what it has written."""
        if isinstance(scene, str):
            scene = self.write(f"{name}.prm", scene)
        self.execute(scene, *overrides(dict(keys)), output=self.work / name,
                     **options)
        return Run(self.work / name)

    def write(self, name, text):
        """A file in the directory."""
        path = self.work / name
        path.write_text(text)
        return path


def assert_same_file(a, b):
    assert Path(a).read_bytes() == Path(b).read_bytes(), f"{a} and {b} differ"


def assert_same_columns(a, b, tolerances=None, ignore=()):
    """Two CSV files with the same rows, but for the columns named."""
    tolerances = tolerances or {}
    one, other = read_csv(a), read_csv(b)
    assert one.dtype.names == other.dtype.names
    assert len(one) == len(other), f"rows of {a} and {b}"
    for name in one.dtype.names:
        if name not in ignore:
            difference = abs(one[name] - other[name]).max()
            assert difference <= tolerances.get(name, 0.0), (
                f"column {name} of {a} and {b}")


class Runs(Calls):
    """The fixture `runs`: one for each file of tests, which can share runs."""

    def __init__(self, options, module):
        self.options = options
        self.work = empty_directory(options, module)


class ProgramTest(unittest.TestCase, Calls):
    """A test with the program and an empty directory of its own. New tests are
    functions that take the fixture `runs`."""

    options = None  # those of tests/conftest.py
    maxDiff = None
    assert_same_file = staticmethod(assert_same_file)
    assert_same_columns = staticmethod(assert_same_columns)
    run_words = Calls.call

    def setUp(self):
        self.work = empty_directory(self.options, self.id())
