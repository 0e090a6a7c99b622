# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""--help of every command in contrib/ and contrib/upkeep, and of those of the program,
prints how it is called, and does nothing else: no build, no installation."""
import os
import re

import pytest
from morula.__main__ import TOOLS
from morula.execute import call
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
    name = command.rpartition("/")[2]
    if TOOLS.get(name, "").startswith("morula."):
        command = f"morula {name.removeprefix('cell-')} "
    assert ended.stdout.removeprefix("usage: ").startswith(command)
    assert not (runs.work / "called").exists()


def test_commands(runs):
    """The program starts each tool of an installation by its first word, if that is no file."""
    program = runs.options.morula
    listed = re.search(r"Commands.*?\n\n", runs.call([program, "--help"]).stdout, re.S)[0]
    words = re.findall(r"^  (\w+)", listed, re.M)
    tools = [name.removeprefix("cell-") for name, module in TOOLS.items()
             if module.startswith("morula.")]
    assert sorted(words) == sorted([*tools, "explain", "keys"])
    for word in ("shapes", "export", "explain", "keys"):
        printed = runs.call([program, word, "-h"], call=call).stdout
        assert printed.startswith(f"usage: morula {word} ") and printed.count("\n") < 100
    (runs.work / "report").write_text("set Dimension = 1\n")
    assert "Dimension" in runs.call([program, "report"], 1, cwd=runs.work, call=call).stderr
    alone = runs.work / "alone"
    alone.symlink_to(program)  # the program is found by its own place
    assert runs.call([alone, "render", "-h"], call=call).code == 0
