# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measured tables are data of this version, and pages show them all; limits in
pages are those that the cases assert."""
import re

from tests.common.program import TESTS, ProgramTest
from upkeep import limits
from upkeep.version_data import (LINK, markdown, newest, parts, read, shown,
                                 store, version)

from tests.cases.case import Case, Limit

ROOT = TESTS.parent
DATA = sorted((ROOT / "doc/measured").glob("*/*.json"))

TABLE = """*Full size.*

| trial | Σ\\|·\\| |
| --- | ---: |
| a | 1.2 |
| b |  |

```
contrib/x
    | no table |
```

- one
- two"""
PARTS = [{"text": ["*Full size.*"]},
         {"header": ["trial", "Σ|·|"], "rows": [["a", "1.2"], ["b", ""]]},
         {"code": ["contrib/x", "    | no table |"]},
         {"text": ["- one", "- two"]}]

MEASUREMENT = (
    r"\b(EPYC|Xeon|[Mm]edians? of)\b",
    r"\d (ms|s|seconds|GiB) (of|on|instead|for|a|per)\b",
    r"\d(\.\d+)? times (as fast|faster|as long as)\b",
    r"\d\s%\s(too|faster|slower|off|low|high|less|more time)\b",
    r"\d\s(Newton|linear)\s+iterations\b",
    r"\b\d[\d.,·]* instead of \d",
    r"\b([Aa]bout|[Ss]ome) (\d+|half an) (GB|MB|minutes|hours?)\b")


def pages():
    """Those that are not frozen."""
    return [page for page in (ROOT / "doc").rglob("*.md")
            if page.parent != ROOT / "doc/notes"]


class Measured(ProgramTest):
    def test_parts_of_a_table(self):
        self.assertEqual(parts(TABLE), PARTS)
        back = markdown({"made": "today", "parts": PARTS})
        self.assertEqual(back.replace("| --- | --- |", "| --- | ---: |"),
                         TABLE + "\n\n*today*")

    def test_store(self):
        """Other tables of the page stay; rows are lines of the file."""
        project = "project(Morula VERSION 3.2.1 LANGUAGES CXX)\n"
        (self.work / "CMakeLists.txt").write_text(project)
        store("a", {"one": TABLE, "two": "text"}, "then", self.work)
        file = store("a", {"two": TABLE}, "now", self.work)
        self.assertEqual(file, self.work / "doc/measured/3.2.1/a.json")
        self.assertEqual(read(file), {
            "page": "doc/a.md", "version": "3.2.1",
            "tables": {"one": {"made": "then", "parts": PARTS},
                       "two": {"made": "now", "parts": PARTS}}})
        self.assertEqual(file.read_text().count('["a", "1.2"]'), 2)
        text = "a\n\n[Measured: two](measured/3.2.1/a.json)\n\nb"
        self.assertIn("| a | 1.2 |", shown(text, self.work / "doc"))

    def test_a_new_version(self):
        """Pages show the tables of the last version that has measured them:
        storing one turns its link, and no other's."""
        def project(number):
            (self.work / "CMakeLists.txt").write_text(
                f"project(Morula VERSION {number} LANGUAGES CXX)\n")

        page = self.work / "doc/a.md"
        project("3.9.1")
        store("a", {"one": "first", "two": "second"}, "then", self.work)
        old = [f"[Measured: {name}](measured/3.9.1/a.json)"
               for name in ("one", "two")]
        page.write_text("\n\n".join(old) + "\n")
        project("3.10.0")
        store("a", {"two": "third"}, "now", self.work)
        self.assertEqual(page.read_text().split(), f"{old[0]} "
                         "[Measured: two](measured/3.10.0/a.json)".split())
        text = shown(page.read_text(), page.parent)
        self.assertIn("first", text)
        self.assertIn("third", text)
        self.assertEqual({name: table["made"] for name, table in
                          newest("a", self.work).items()},
                         {"one": "then", "two": "now"})

    def test_tables_of_a_directory(self):
        """Tables of all pages beside a README are in one file: links in each of
        them turn, and that to the file."""
        self.write("CMakeLists.txt", "project(Morula VERSION 2.0.0 LANGUAGES CXX)\n")
        steps = self.work / "doc/steps"
        steps.mkdir(parents=True)
        for name in ("README", "step-1", "step-2"):
            (steps / f"{name}.md").write_text(
                "[data](../measured/1.0.0/steps.json)\n"
                f"[Measured: {name}](../measured/1.0.0/steps.json)\n")
        store("steps", {"step-1": "text"}, "now", self.work)
        for name in ("README", "step-1", "step-2"):
            version = "2.0.0" if name == "step-1" else "1.0.0"
            self.assertEqual(
                (steps / f"{name}.md").read_text(),
                "[data](../measured/2.0.0/steps.json)\n"
                f"[Measured: {name}](../measured/{version}/steps.json)\n")

    def test_every_table_has_its_place(self):
        """Once, in a page, as the last version that measured it has it; all of
        this version's are shown."""
        named = []
        for page in pages():
            for name, link in LINK.findall(page.read_text()):
                file = (page.parent / link).resolve()
                self.assertIn(file, DATA, page)
                self.assertEqual(read(file)["tables"][name],
                                 newest(file.stem)[name], page)
                named.append((file, name))
            self.assertEqual(len(LINK.findall(page.read_text())),
                             page.read_text().count("[Measured: "), page)
        self.assertEqual(len(named), len({(file.stem, name)
                                          for file, name in named}))
        self.assertGreater(len(named), 30)
        ours = {(file, name) for file in DATA
                if file.parent.name == version()
                for name in read(file)["tables"]}
        self.assertLessEqual(ours, set(named))

    def test_data_say_how_they_were_made(self):
        for file in DATA:
            data = read(file)
            self.assertEqual(data["version"], file.parent.name, file)
            self.assertTrue((ROOT / data["page"]).is_file(), file)
            for name, table in data["tables"].items():
                with self.subTest(file=file.name, table=name):
                    self.assertRegex(table["made"],
                                     r"^\d{4}-\d\d-\d\d: .*commit .*cores$")
                    self.assertTrue(table["parts"])
                    for part in table["parts"]:
                        for row in part.get("rows", ()):
                            self.assertEqual(len(row), len(part["header"]))

    def test_shown_by_the_command(self):
        text = self.run_words([ROOT / "contrib/upkeep/renew", "--show",
                               "verification"]).stdout
        for name in newest("verification"):
            self.assertIn(f"# verification: {name}\n", text)


class Prose(ProgramTest):
    def test_no_page_tells_of_a_measurement(self):
        """Words that come with measured numbers: a machine, a time, how much
        faster, how far off. A limit that a test asserts stands in a list."""
        for page in [ROOT / "README.md", *pages()]:
            if page.parent.name == "changes" or page.name == "parameters.md":
                continue
            text = limits.PLACE.sub("", page.read_text())
            for pattern in MEASUREMENT:
                found = re.search(pattern, text)
                self.assertIsNone(found, page)


class Limits(ProgramTest):
    def test_pages_have_the_limits_of_the_cases(self):
        """`contrib/upkeep/renew --limits` writes them."""
        for page, text, wanted in limits.pages(ROOT):
            self.assertEqual(text, wanted, f"{page}: contrib/upkeep/renew --limits")
            self.assertGreater(len(limits.PLACE.findall(text)), 5)

    def test_sentences_name_their_limit(self):
        for folder in limits.CASES.values():
            for case, lines in limits.sentences(folder, ROOT).items():
                for line in lines:
                    self.assertRegex(line, r"\d.*\.$", case)

    def test_a_limit_that_nothing_is_found_for(self):
        limit = Limit("The condition varies by less than a factor {at_most:g}.",
                      at_most=3)
        case = Case("a", [], None, (limit,))
        said = "The condition varies by less than a factor 3."
        self.assertEqual(case.sentences(), [said])
        self.assertEqual(case.unfounded([]), [said])
        found = limit.found("condition", 2)
        self.assertEqual(case.unfounded([found]), [])
        self.assertTrue(found.holds())
        self.assertFalse(limit.found("condition", 4).holds())

    def test_places(self):
        page = "x\n<!-- limits a -->\nold\n<!-- end -->\ny\n"
        new = limits.page_with(page, {"a": ["One.", "Two."], "b": []})
        self.assertEqual(re.sub("- One.\n- Two.", "old", new), page)
        for stated in ({"a": ["One."], "b": ["Two."]}, {"b": ["Two."]}):
            self.assertRaises(LookupError, limits.page_with, page, stated)

