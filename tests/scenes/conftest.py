# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Scenes: runs of the whole program that a closed form, an exact balance or a
reference judges."""
import re

import pytest

from morula.execute import overrides

from tests.common.program import SCENES
from tests.common.results import Results

# Of all scenes that are keys alone.
USUAL = {"Time/End time": 1, "Time/Step": 1, "Solver/Newton tolerance": 1e-10,
         "Output/Formats": "csv", "Output/Interval": 0}


@pytest.fixture
def scene(runs, request):
    """Runs a scene, keys beside the usual ones or beside those of a file of this
    directory, and returns its results; they stand in a directory with the test's
    name. `then`: keys with which the run goes on afterwards."""
    name = re.sub(r"[^\w.-]+", "-", request.node.name.removeprefix("test_"))

    def run(keys=(), file=None, ranks=1, then=None):
        prm = SCENES / file if file else ""
        usual = {} if file else USUAL
        runs.run(name, prm, {**usual, **dict(keys)}, ranks=ranks)
        if then:
            runs.execute(prm or runs.work / f"{name}.prm", "--resume",
                         *overrides({**usual, **then}), output=runs.work / name)
        return Results(runs.work / name)
    return run
