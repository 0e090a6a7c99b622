# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/python: one package with one way to start it, and the lists of its
tools, of CMake and of pyproject.toml are the same."""
import re

import tomllib
from morula.__main__ import TOOLS
from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent
PYTHON = ROOT / "contrib/python"
WORD = "sys." + "path"  # not found in this file


class Packages(ProgramTest):
    def test_nobody_changes_the_path(self):
        for folder in ("contrib", "tests", "doc"):
            for file in (ROOT / folder).rglob("*"):
                if file.is_file() and file.suffix in ("", ".py", ".md", ".cmake"):
                    for line in file.read_text(errors="replace").splitlines():
                        self.assertNotRegex(
                            line, rf"{re.escape(WORD)}(\.|\[|\s*\+?=)", file)

    def test_tools(self):
        """Every tool has its script, its module, and is installed if it does
        not need the tree."""
        installed = [name for name, module in TOOLS.items()
                     if module.startswith("morula.")]
        for name, module in TOOLS.items():
            folder = "contrib/upkeep" if module.startswith(
                ("upkeep.", "tests.")) else "contrib"
            script = (ROOT / folder / name).read_text()
            self.assertIn(f"python/launch\" -P -m morula {name} ", script)
            folder = ROOT if module.startswith("tests") else PYTHON
            self.assertTrue((folder / f"{module.replace('.', '/')}.py")
                            .is_file(), module)
        cmake = (ROOT / "contrib/cmake/install.cmake").read_text()
        self.assertEqual(re.search(r"foreach\(tool (.*)\)", cmake)[1].split(),
                         installed)
        project = tomllib.loads((PYTHON / "pyproject.toml").read_text())
        self.assertEqual(list(project["project"]["scripts"]),
                         [f"morula-{name}" for name in installed])
        version = re.search(r"project\(Morula VERSION (\S+)",
                            (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(project["project"]["version"], version)

    def test_an_installed_package_needs_no_other(self):
        """Nothing of `morula` is imported from the tree's own packages."""
        for file in (PYTHON / "morula").rglob("*.py"):
            self.assertNotRegex(
                file.read_text(),
                r"(?m)^\s*(from|import) (tests|upkeep|reproduction)\b", file)

    def test_unknown_tool(self):
        found = self.run_words([PYTHON / "launch", "-P", "-m", "morula",
                                "nothing"], code=1)
        self.assertIn("there is no tool 'nothing'; there are accuracy,",
                      found.stderr)

