# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""doc/man: a page for each command that is installed, as --help says it; pages that
readers of manuals take without a word; completion that knows the commands."""
import re
import shutil
import subprocess

import pytest
from morula.__main__ import TOOLS
from upkeep.man_pages import SUMMARIES, page_of

from tests.common.program import TESTS

pytestmark = pytest.mark.release

ROOT = TESTS.parent
COMPLETION = ROOT / "contrib/completion/morula"


def words_of(page):
    """A page without what depends on Python's and help2man's version: before 3.13 a value
    is named behind each form of an option, "-s KEY=VALUE, --set KEY=VALUE"."""
    page = re.sub(r"(\\fB\\-\w\\fR) [A-Z=,]+(, \\fB)", r"\1\2", page.partition("\n")[2])
    return page.split()


def test_each_command_has_one():
    installed = {f"morula-{name}" for name, module in TOOLS.items()
                 if module.startswith("morula.")} | {"morula"}
    assert set(SUMMARIES) == installed
    assert {file.stem for file in (ROOT / "doc/man").iterdir()} == installed


@pytest.mark.parametrize("name", SUMMARIES)
def test_page(runs, name):
    """contrib/upkeep/man-pages writes them."""
    file = ROOT / f"doc/man/{name}.1"
    page = file.read_text(encoding="utf-8")
    assert words_of(page_of(name, runs.options.morula)) == words_of(page)
    assert not re.search(r"contrib/(?!python)", page.replace("\\-", "-"))
    if shutil.which("mandoc"):
        runs.call(["mandoc", "-T", "lint", "-W", "warning", file])
    assert re.search(rf"(?m)^complete .*\b{name.removeprefix('morula-')}\b", COMPLETION.read_text())


def complete(work, *words):
    """What bash would propose for the last of these words."""
    script = (f". {COMPLETION}; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); "
              "_morula \"$1\" \"${!#}\" \"${COMP_WORDS[COMP_CWORD - 1]}\"; "
              "printf '%s\\n' \"${COMPREPLY[@]}\"")
    done = subprocess.run(["bash", "-uc", script, "bash", *map(str, words)], cwd=work,
                          text=True, stdout=subprocess.PIPE, check=True)
    return sorted(done.stdout.split("\n")[:-1])


def test_completion(runs):
    for name in ("bud.prm", "budding.csv"):
        runs.write(name, "")
    (runs.work / "buds").mkdir()
    morula, render = runs.options.morula, ROOT / "contrib/render"
    for words, found in (
            ((morula, "bu"), ["bud.prm", "buds"]),
            ((morula, "--re"), ["--replace", "--resume"]),
            ((morula, "re"), ["render", "report"]), ((morula, "render", "--mo"), ["--movie"]),
            ((morula, "report", "budd"), ["budding.csv"]),
            ((morula, "bud.prm", "-s", "Time/S"),
             ["Time/Smallest step=", "Time/Step=", "Time/Stop at cells="]),
            ((morula, "bud.prm", "-s", "Time/End\\ t"), ["Time/End time="]),
            ((morula, "bud.prm", "-s", '"Time/End t'), ["Time/End time="]),
            ((render, "--mo"), ["--movie"]),
            ((render, "bu"), ["bud.prm", "budding.csv", "buds"])):
        assert complete(runs.work, *words) == found
