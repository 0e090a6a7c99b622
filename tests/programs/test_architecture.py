# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""doc/architecture.md: its rooms are those of tests/check_includes, its types and
functions are in the files that it names, and each equation of the paper is in
its table with a file that names the equation."""
import re
import runpy

from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent
PAPER = range(1, 21)


def page():
    return (ROOT / "doc/architecture.md").read_text(encoding="utf-8")


def rows(heading):
    """The cells of the table below a heading, row by row, without its head."""
    section = page().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    table = [line.strip("| ").split(" | ") for line in section.splitlines()
             if line.startswith("|")]
    return table[2:]


def text_of(path):
    """The text of the files that a path without an ending means, one line."""
    text = ""
    for folder, ending in (("include/morula", "h"), ("source", "cc")):
        file = ROOT / folder / f"{path}.{ending}"
        if file.exists():
            text += file.read_text(encoding="utf-8")
    return re.sub(r"\s*\n\s*(?:\*|//)?\s*", " ", text)


def equations_named(text):
    """The numbers of "equation (8) of the paper", "Equations (19), (20)", ..."""
    lists = re.findall(r"[Ee]quations? ((?:\(\d+\)(?:, and |, | and )?)+)", text)
    return {number for one in lists for number in re.findall(r"\(\d+\)", one)}


class Architecture(ProgramTest):
    def test_it_is_one_page(self):
        self.assertLess(len(page().splitlines()), 120)

    def test_rooms(self):
        rooms = runpy.run_path(str(TESTS / "check_includes"))["ROOMS"]
        table = {row[0].strip("`"): row[2] for row in rows("The rooms")}
        self.assertEqual(sorted(table), sorted(rooms))
        above = set()
        for room, words in table.items():
            may = set(re.findall(r"`(\w+)`", words))
            if words == "all above":
                may = set(above)
            with self.subTest(room):
                self.assertEqual(may, set(rooms[room]) - {room}
                                 - {"program", "simulation", "steps"})
            if room not in ("program", "simulation", "steps"):
                above.add(room)

    def test_types_and_functions_are_where_it_says(self):
        named = re.findall(r"`(\w+)(?:\(\))?` in `([\w/]+)(?:\.cc)?`", page())
        self.assertGreater(len(named), 8)
        for name, path in named:
            with self.subTest(name):
                self.assertRegex(text_of(path), rf"\b{name}\b")

    def test_files_exist(self):
        rooms = "|".join(row[0].strip("`") for row in rows("The rooms"))
        for name, least in (("architecture", 20), ("theory", 40)):
            text = (ROOT / f"doc/{name}.md").read_text(encoding="utf-8")
            paths = re.findall(rf"`((?:{rooms})/[\w/]+)(?:\.h|\.cc)?`", text)
            self.assertGreater(len(paths), least)
            self.assertEqual([path for path in paths if not text_of(path)
                              and not (ROOT / "source" / path).is_dir()], [],
                             f"doc/{name}.md names files that do not exist")

    def test_functions_of_a_step_are_called(self):
        block = page().split("## One step")[1].split("```")[1]
        calls = re.findall(r"^ +(?:\w+\.)?(\w+)\(\)", block, flags=re.M)
        self.assertGreater(len(calls), 8)
        text = text_of("simulation/simulation") + \
            text_of("simulation/step_equilibrium")
        self.assertEqual([name for name in calls
                          if not re.search(rf"\b{name}\(", text)], [])

    def test_equations_of_the_paper(self):
        table = rows("From the paper to the code")
        self.assertEqual([row[0] for row in table],
                         [f"({number})" for number in PAPER])
        theory = (ROOT / "doc/theory.md").read_text(encoding="utf-8")
        for paper, _, place, file in table:
            with self.subTest(paper):
                if place.startswith("("):
                    self.assertIn(rf"\tag{{{place.strip('()')}}}", theory)
                else:
                    self.assertIn(f"### {place.split()[1]} ", theory)
                text = text_of(file.strip("`"))
                self.assertIn(paper, equations_named(text),
                              f"{file} does not name the paper's {paper}")

