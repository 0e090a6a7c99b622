# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""--help of every command in contrib/ and contrib/upkeep prints how it is called, and
does nothing else: no build, no installation."""
import os

import pytest
from tests.common.program import TESTS

ROOT = TESTS.parent
COMMANDS = sorted(file for folder in ("contrib", "contrib/upkeep")
                  for file in (ROOT / folder).iterdir()
                  if file.is_file() and os.access(file, os.X_OK))
# argparse takes both words alike.
CALLS = [(str(command.relative_to(ROOT)), word) for command in COMMANDS
         for word in ("--help", "-h")
         if word == "--help" or "-m morula" not in command.read_text()]
OTHERS = ("apt-get", "cmake", "cpack", "ctest", "debootstrap", "doxygen", "dpkg-query", "ninja")


@pytest.fixture(scope="module")
def without_others(runs):
    """A path on which the programs that commands call only note that they were."""
    folder = runs.work / "bin"
    folder.mkdir()
    for name in OTHERS:
        file = folder / name
        file.write_text(f'#!/bin/sh\necho "$0" >>{runs.work}/called\nexit 1\n')
        file.chmod(0o755)
    return f"PATH={folder}:{os.environ['PATH']}"


@pytest.mark.parametrize("command, word", CALLS)
def test_help(runs, without_others, command, word):
    (runs.work / "called").unlink(missing_ok=True)
    ended = runs.call(["env", without_others, command, word], cwd=ROOT)
    assert ended.stdout.removeprefix("usage: ").startswith(command)
    assert not (runs.work / "called").exists()
