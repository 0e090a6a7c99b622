# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/python: one package with one way to start it, and the lists of its tools,
of CMake and of pyproject.toml are the same."""
import re
import tomllib

import pytest
from morula.__main__ import PACKAGES, TOOLS, missing
from tests.common.program import TESTS

pytestmark = pytest.mark.quick
ROOT = TESTS.parent
PYTHON = ROOT / "contrib/python"
WORD = "sys." + "path"  # not found in this file


def test_nobody_changes_the_path():
    changed = re.compile(rf"{re.escape(WORD)}(\.|\[|\s*\+?=)")
    for folder in ("contrib", "tests", "doc"):
        for file in (ROOT / folder).rglob("*"):
            if file.is_file() and file.suffix in ("", ".py", ".md", ".cmake"):
                assert not changed.search(file.read_text(errors="replace")), file


def test_tools():
    """Every tool has its script, its module, and is installed if it does not need
    the tree."""
    installed = [name for name, module in TOOLS.items()
                 if module.startswith("morula.")]
    for name, module in TOOLS.items():
        folder = "contrib/upkeep" if module.startswith(
            ("upkeep.", "tests.")) else "contrib"
        assert f"python/launch\" -P -m morula {name} " in (
            ROOT / folder / name).read_text()
        folder = ROOT if module.startswith("tests") else PYTHON
        assert (folder / f"{module.replace('.', '/')}.py").is_file()
    cmake = (ROOT / "contrib/cmake/install.cmake").read_text()
    assert re.search(r"foreach\(tool (.*)\)", cmake)[1].split() == installed
    project = tomllib.loads((PYTHON / "pyproject.toml").read_text())["project"]
    assert list(project["scripts"]) == [f"morula-{name}" for name in installed]
    version = re.search(r"project\(Morula VERSION (\S+)",
                        (ROOT / "CMakeLists.txt").read_text())[1]
    assert project["version"] == version


def test_an_installed_package_needs_no_other():
    """Nothing of `morula` is imported from the tree's own packages."""
    for file in (PYTHON / "morula").rglob("*.py"):
        assert not re.search(r"(?m)^\s*(from|import) (tests|upkeep|reproduction)\b",
                             file.read_text()), file


def test_missing_libraries():
    """Debian's package is named; what is no library of the tools is no such error."""
    for library, package in PACKAGES.items():
        assert package in missing(ModuleNotFoundError(name=f"{library}.part"))
    assert missing(ModuleNotFoundError(name="morula")) is None


def test_unknown_tool(runs):
    assert "there is no tool 'nothing'" in runs.call(
        [PYTHON / "launch", "-P", "-m", "morula", "nothing"], 1).stderr
