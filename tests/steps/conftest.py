# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The step programs, on the number of ranks of the command."""
from pathlib import Path

import pytest
from morula.execute import overrides

PRM = Path(__file__).resolve().parents[2] / "prm"


class Step:
    """Runs a step into a directory of the test."""

    def __init__(self, runs, name):
        self.runs, self.output = runs, runs.work / name
        self.program = Path(runs.options.morula)

    def __call__(self, keys=(), *words, code=0, output=None, prm=None):
        """Runs it with its own .prm file, or another one, and returns what it
        printed."""
        prm = prm or PRM / f"{self.program.name}.prm"
        result = self.runs.execute(prm, *overrides(dict(keys)), *words,
                                   ranks=self.runs.options.ranks,
                                   output=output or self.output, code=code)
        return result.stderr if code else result.stdout


@pytest.fixture
def step(runs, request):
    return Step(runs, request.node.name)
