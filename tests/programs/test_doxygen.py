# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/upkeep/doxygen has nothing to complain about, and ends with an error where it
has."""
import shutil

import pytest

from tests.common.program import TESTS

pytestmark = pytest.mark.release

ROOT = TESTS.parent


def test_no_warning(runs):
    runs.call([ROOT / "contrib/upkeep/doxygen", runs.work / "doc"])
    assert "Nitsche" in (runs.work / "doc/classMorula_1_1Nitsche.html").read_text()


def test_a_wrong_comment(runs):
    root = runs.work / "copy"
    for name in ("contrib/upkeep", "doc", "include/morula/base"):
        shutil.copytree(ROOT / name, root / name)
    (root / "include/morula/wrong.h").write_text(
        "namespace Morula\n{\n  /** @param b is none */\n  void\n  twice(const int a);\n}\n")
    said = runs.call([root / "contrib/upkeep/doxygen", runs.work / "wrong"], code=1)
    assert "argument 'b' of command @param is not found" in said.text
