# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Code that pages quote, in a block below <!-- from FILE -->, is in that file.

The lines must stand there as quoted, one below the other, but for the
indentation of them all. A line "..." stands for lines that are left out.
"""
import re
import textwrap
from pathlib import Path

from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent
QUOTED = re.compile(r"^<!-- from (\S+) -->\n```\w*\n(.*?)^```$", re.M | re.S)
BLOCK = re.compile(r"^```\w*\n.*?^```$", re.M | re.S)


def pages():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md",
            *sorted(page for page in (ROOT / "doc").rglob("*.md")
                    if page.parent != ROOT / "doc/notes")]


def parts(quotation):
    """Its lines between those that say "..."."""
    return [textwrap.dedent(part).strip("\n") for part in
            re.split(r"^\s*\.\.\.\s*$", quotation, flags=re.M)]


def missing(quotation, text):
    """The first part of a quotation that does not follow in a text, or None."""
    lines = text.splitlines()
    at = 0
    for part in parts(quotation):
        n = len(part.splitlines())
        found = [i for i in range(at, len(lines) - n + 1)
                 if textwrap.dedent("\n".join(lines[i:i + n])) == part]
        if not found:
            return part
        at = found[0] + n
    return None


def named_functions(text):
    """(function, end of a path) of every "`function()` in `path`"."""
    for line in text.splitlines():
        for name, path in re.findall(
                r"`(?:\w+::)?(\w+)\(\)` in `([\w/]+\.(?:cc|h))`", line):
            yield name, path


class Quotations(ProgramTest):
    def test_they_are_in_the_files(self):
        for page in pages():
            for name, quotation in QUOTED.findall(page.read_text()):
                with self.subTest(page=page.name, file=name):
                    part = missing(quotation, (ROOT / name).read_text())
                    self.assertIsNone(part, f"{name} has no such lines")

    def test_all_code_about_effects_is_quoted(self):
        text = (ROOT / "doc/adding-an-effect.md").read_text()
        self.assertGreater(len(QUOTED.findall(text)), 10)
        self.assertEqual(BLOCK.findall(QUOTED.sub("", text)), [],
                         "which file is this from?")

    def test_functions_are_where_it_says(self):
        text = (ROOT / "doc/adding-an-effect.md").read_text()
        self.assertGreater(len(list(named_functions(text))), 5)
        for name, path in named_functions(text):
            with self.subTest(name):
                files = [file for folder in ("source", "include")
                         for file in (ROOT / folder).rglob(Path(path).name)
                         if file.as_posix().endswith("/" + path)]
                self.assertEqual(len(files), 1, path)
                self.assertRegex(files[0].read_text(), rf"\b{name}\(")

    def test_differences_are_found(self):
        text = "int a;\n{\n  b();\n  if (c)\n    d();\n}\n"
        for quotation in ("b();\nif (c)\n  d();", "int a;\n...\n    d();\n}",
                          "  b();\n", "{\n...\n}"):
            self.assertIsNone(missing(quotation, text), quotation)
        for quotation in ("b();\nif (c)\nd();", "b();\nd();", "b(1);",
                          "d();\n...\nint a;", "int a;\n\n{"):
            self.assertIsNotNone(missing(quotation, text), quotation)

