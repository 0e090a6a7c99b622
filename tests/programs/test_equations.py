# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The equations of doc/theory.md: each is numbered, once, and named by the code
that computes it as "doc/theory.md (4.2)", or "doc/theory.md (4.2), (4.4)"; and
the code names no other ones."""
import re

from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent

# Equations that no code computes as they stand, and why.
EXCEPTIONS = {}

NUMBER = r"\((\d+\.\d+[a-z]?)\)"
CITATION = re.compile(rf"theory\.md,? ((?:{NUMBER}(?:, | and )?)+)")


def theory():
    return (ROOT / "doc/theory.md").read_text(encoding="utf-8")


def equations():
    """The numbers of the displayed equations, in order."""
    return re.findall(r"\\tag\{([^}]*)\}", theory())


def citations(text):
    """The numbers named in a source file, whose comments may break lines."""
    text = re.sub(r"\s*\n\s*(?:\*|//|#)?\s*", " ", text)
    return [number for match in CITATION.finditer(text)
            for number in re.findall(NUMBER, match[1])]


def sources():
    for folder in ("include", "source", "contrib", "tests"):
        for file in sorted((ROOT / folder).rglob("*")):
            if (file.suffix in (".h", ".cc", ".py") and file.is_file()
                    and file.name != "equations.py"):
                yield file


class Equations(ProgramTest):
    def test_each_is_numbered_once(self):
        blocks = re.findall(r"```math\n(.*?)```", theory(), flags=re.S)
        self.assertGreater(len(blocks), 30)
        for block in blocks:
            self.assertEqual(block.count(r"\tag{"), 1, block)
        numbers = equations()
        self.assertEqual(len(numbers), len(set(numbers)), numbers)

    def test_numbers_rise_within_their_section(self):
        section, last = 0, None
        for line in theory().splitlines():
            heading = re.match(r"## (\d+) ", line)
            if heading:
                section, last = int(heading[1]), 0
            for number in re.findall(r"\\tag\{([^}]*)\}", line):
                chapter, n, letter = re.fullmatch(
                    r"(\d+)\.(\d+)([a-z]?)", number).groups()
                self.assertEqual(int(chapter), section, number)
                self.assertEqual(int(n), last + (not letter), number)
                last = int(n)

    def test_the_text_names_existing_ones(self):
        text = re.sub(r"```math\n.*?```|\$[^$]*\$", "", theory(), flags=re.S)
        named = set(re.findall(NUMBER, text))
        self.assertGreater(len(named), 10)
        self.assertEqual(named - set(equations()), set())

    def test_the_code_names_existing_ones_and_all(self):
        known = equations()
        named = {}
        for file in sources():
            for number in citations(file.read_text(encoding="utf-8")):
                named.setdefault(number, file.relative_to(ROOT).as_posix())
        wrong = {number: file for number, file in named.items()
                 if number not in known}
        self.assertEqual(wrong, {}, "doc/theory.md has no such equations")
        self.assertEqual([number for number in known if number not in named
                          and number not in EXCEPTIONS], [],
                         "no code names these equations of doc/theory.md")
        self.assertEqual([number for number in EXCEPTIONS if number in named
                          or number not in known], [], "no exceptions")

