# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Options, rings and fixtures of the tests in Python: tests/README.md."""
import os
import re
from pathlib import Path

import pytest

pytest.register_assert_rewrite("tests.common")

from tests.common.cases import Case, Table  # noqa: E402
from tests.common.program import Runs  # noqa: E402

BUILD = Path(__file__).resolve().parents[1] / "build"
RINGS = ("quick", "check", "release")


def pytest_addoption(parser):
    parser.addoption("--morula", default=BUILD / "morula", type=Path,
                     help="the executable")
    parser.addoption("--mpiexec", default="mpiexec")
    parser.addoption("--ranks", default=1, type=int, help="of steps and scenes")
    parser.addoption("--work", default=BUILD / "tests", type=Path,
                     help="directory for the runs")
    parser.addoption("--ring", default=os.environ.get("MORULA_RING", "check"),
                     choices=RINGS, help="which tests: each ring has the former")
    parser.addoption("--update", action="store_true",
                     help="write the references of scenes instead of comparing")
    parser.addoption("--tables", type=Path,
                     help="directory for the tables of verification and hard cases")


def pytest_configure(config):
    options = config.option
    options.morula, options.work = (Path(os.path.abspath(path))
                                    for path in (options.morula, options.work))
    os.environ.pop("OMP_NUM_THREADS", None)


def ring_of(item):
    """The smallest ring that has a test: that of its nearest mark."""
    mark = next((mark.name for mark in item.iter_markers()
                 if mark.name in RINGS), "check")
    return RINGS.index(mark)


def pytest_collection_modifyitems(config, items):
    most = RINGS.index(config.option.ring)
    left = [item for item in items if ring_of(item) > most]
    config.hook.pytest_deselected(items=left)
    items[:] = [item for item in items if ring_of(item) <= most]


@pytest.fixture(scope="module")
def runs(request):
    """Runs of the program for all tests of a file, in a directory of theirs."""
    return Runs(request.config.option, request.module.__name__)


@pytest.fixture
def fresh(request):
    """The same for one test, in a directory that is empty."""
    name = re.sub(r"\W+", "-", request.node.name)[:80]
    return Runs(request.config.option, f"{request.module.__name__}/{name}")


@pytest.fixture(scope="module")
def table(request):
    """The table of a case; --tables DIR: written as DIR/NAME.md."""
    rows = Table()
    yield rows
    if request.config.option.tables and rows.parts:
        name = request.module.__name__.rpartition(".test_")[2]
        folder = request.config.option.tables
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}.md").write_text(rows.markdown(), encoding="utf-8")


@pytest.fixture(scope="module")
def case(request, table):
    """A hard case, or one of verification."""
    runs = Case(request.config.option, request.module.__name__, table)
    yield runs
    if request.config.option.tables:
        runs.finish()
