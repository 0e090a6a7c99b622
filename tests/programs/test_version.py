# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The commit that --version names, of a clone, of a release, and of sources without git
(contrib/cmake/version.cmake); a release's entries of doc/changes move to CHANGES.md."""
import re
import shutil

import pytest

from tests.common.program import TESTS

pytestmark = pytest.mark.release

ROOT = TESTS.parent


def test_commit(runs):
    tree, file = runs.work / "tree", runs.work / "version.cc"
    (tree / "source/base").mkdir(parents=True)
    shutil.copy(ROOT / "source/base/version.cc.in", tree / "source/base")

    def git(*words):
        runs.call(["git", "-C", tree, "-c", "user.name=A", "-c", "user.email=a@b", *words])

    def commit():
        """What the file says that is written in a build of the tree."""
        runs.call(["cmake", f"-Dsource={tree}", "-Dnumber=1.2.3", f"-Doutput={file}", "-P",
                   ROOT / "contrib/cmake/version.cmake"])
        assert 'return "1.2.3";' in file.read_text()
        return re.search(r'commit = "(.*)"', file.read_text())[1]

    assert commit() == ""  # sources without git
    git("init", "-q")
    assert commit() == ""  # a clone without a commit
    git("add", ".")
    git("commit", "-qm", "One")
    assert re.fullmatch("[0-9a-f]{10}", commit())
    before = file.stat().st_mtime_ns
    commit()
    assert file.stat().st_mtime_ns == before  # nothing is compiled for the same
    git("tag", "v1.2.3")
    assert commit() == ""  # the release itself
    git("commit", "-qm", "Two", "--allow-empty")
    assert re.fullmatch("v1.2.3-1-g[0-9a-f]{10}", commit())
    with (tree / "source/base/version.cc.in").open("a") as template:
        template.write("\n")
    assert re.fullmatch("v1.2.3-1-g[0-9a-f]{10}-dirty", commit())


def test_changes(runs):
    for folder in ("contrib/upkeep", "doc/changes"):
        (runs.work / folder).mkdir(parents=True)
    tool = runs.work / "contrib/upkeep/changes"
    shutil.copy(ROOT / "contrib/upkeep/changes", tool)
    runs.write("CMakeLists.txt", "project(Morula VERSION 0.3.0 LANGUAGES CXX)\n")
    page = runs.write("CHANGES.md", "# Changes\n\n## 0.2.0\n\n### Old\n\n- x\n")
    for name, text in (
            ("README", "# Changes\n"), ("2027-01-b", "# Two\n\n- b\n"),
            ("2027-01-a", "# One\n\n- See [a](../faq.md#b), [s](../../prm/x.prm).\n")):
        runs.write(f"doc/changes/{name}.md", text)
    runs.call([tool])
    one = "### One\n\n- See [a](doc/faq.md#b), [s](prm/x.prm).\n\n### Two\n\n- b\n\n"
    old = "## 0.2.0\n\n### Old\n\n- x\n"
    assert page.read_text() == f"# Changes\n\n## 0.3.0\n\n{one}{old}"
    runs.write("doc/changes/2027-02-c.md", "# Three\n\n- c\n")
    runs.call([tool])
    assert page.read_text() == f"# Changes\n\n## 0.3.0\n\n{one}### Three\n\n- c\n\n{old}"
    assert [file.name for file in (runs.work / "doc/changes").iterdir()] == ["README.md"]
