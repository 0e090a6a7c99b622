# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the step programs."""
from pathlib import Path

from tests.common.program import ProgramTest, overrides, read_csv

ROOT = Path(__file__).resolve().parents[2]


def number(word):
    """NaN for '-', text as it is."""
    try:
        return float("nan" if word == "-" else word)
    except ValueError:
        return word


def tables(text):
    """The tables of deal.II's TableHandler::org_mode_table in a text, each a
    dictionary: column -> list of numbers. A column of rates has the name of the one
    before it with ' rate', the second column of a name has a ' 2' behind it."""
    found, lines = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            lines.append([word.strip() for word in line.split("|")[1:-1]])
        elif lines:
            names = []
            for name in lines[0]:
                name = names[-1] + " rate" if "...red.rate" in name else name
                names.append(f"{name} 2" if name in names else name)
            columns = zip(*lines[1:])
            found.append({name: [number(word) for word in column]
                          for name, column in zip(names, columns)})
            lines = []
    return found


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
