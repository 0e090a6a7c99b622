# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program, for the tests in Python."""
import csv
import shlex
import shutil
from pathlib import Path

from morula.execute import command, overrides
from morula.run import Run

from tests.common import forks
from tests.common.results import read_csv

TESTS = Path(__file__).resolve().parents[1]
ROOT = TESTS.parent
SCENES = TESTS / "scenes"

# Closed forms per initial volume, and balances of the stress at each point.
POINTWISE = {"Material/Energy per": "initial volume", "Material/Volumetric strain": "pointwise"}
WHOLE = {**POINTWISE, "Tissue/Surface cells": "whole", "Tissue/Refine surface": "false"}


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

    def run(self, name, scene, keys=(), *arguments, **options):
        """Runs a scene, a file, its text or its keys, with these keys, into
        work/NAME, and returns what it has written; `said` is what it printed."""
        ended = self.execute(*self._scene(name, scene, keys), *arguments,
                             output=self.work / name, **options)
        run = Run(self.work / name)
        run.said = ended.text
        return run

    def resumed(self, name, scene, keys, until, **options):
        """The same, from a run that ended earlier, at a time (day)."""
        self.run(name, scene, {**keys, "Time/End time": until}, **options)
        return self.run(name, scene, keys, "--resume", **options)

    def refused(self, scene, keys=(), *arguments, **options):
        """What is said of a run that is refused."""
        return self.execute(*self._scene("refused", scene, keys), *arguments,
                            code=1, **options).text

    def explain(self, scene, keys=(), *arguments, code=0):
        """What --explain prints of a scene."""
        return self.call(self.command(*self._scene("explained", scene, keys),
                                      *(arguments or ["--explain"])), code).text

    def _scene(self, name, scene, keys):
        """The words for a scene, which may be text or a dictionary of keys."""
        keys = dict(keys)
        if isinstance(scene, dict):
            scene, keys = "", {**scene, **keys}
        if isinstance(scene, str):
            scene = self.write(f"{name}.prm", scene)
        return [scene, *overrides(keys)]

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


def assert_same_run(whole, resumed):
    """Two runs with the same tables, bit for bit but for wall times."""
    names = {path.name for path in whole.directory.glob("*.csv")}
    assert names == {path.name for path in resumed.directory.glob("*.csv")}
    for name in names - {"statistics.csv", "timings.csv"}:
        assert_same_file(whole.directory / name, resumed.directory / name)
    assert (without_wall_time(whole.directory)
            == without_wall_time(resumed.directory))


class Runs(Calls):
    """The fixture `runs`: one for each file of tests, which can share runs."""

    def __init__(self, options, module):
        self.options = options
        self.work = empty_directory(options, module)
