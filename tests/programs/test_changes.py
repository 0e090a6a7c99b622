# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/upkeep/changes: entries end in the section of their version, once; and
links of CHANGES.md and of the entries lead to files."""
import re

from tests.common.program import TESTS, ProgramTest
from upkeep.changes import move

ROOT = TESTS.parent


class Changes(ProgramTest):
    def entries(self, **texts):
        for name, text in texts.items():
            self.write(f"doc/changes/{name}.md", text)

    def release(self, number):
        self.write("CMakeLists.txt",
                   f"project(Morula VERSION {number} LANGUAGES CXX)\n")
        return len(move(self.work)), (self.work / "CHANGES.md").read_text()

    def setUp(self):
        super().setUp()
        (self.work / "doc/changes").mkdir(parents=True)
        self.entries(README="# Changes\n")

    def test_versions(self):
        self.entries(b="# Two\n\n- See [a page](../faq.md#b), [a scene](../../prm/x.prm).\n",
                     a="# One\n\n- Text,\n  [elsewhere](https://a.org).\n")
        n, page = self.release("0.1.0")
        self.assertEqual(n, 2)
        first = ("## 0.1.0\n\n### One\n\n- Text,\n  [elsewhere](https://a.org).\n\n"
                 "### Two\n\n- See [a page](doc/faq.md#b), [a scene](prm/x.prm).\n")
        self.assertTrue(page.startswith("# Changes\n"))
        self.assertTrue(page.endswith("\n\n" + first), page)
        self.assertEqual(self.release("0.1.0"), (0, page))
        self.entries(c="### Three\n\n- more\n")
        _, page = self.release("0.1.0")
        self.assertTrue(page.endswith(f"{first}\n### Three\n\n- more\n"), page)
        self.entries(d="# Four\n\n- new\n")
        _, page = self.release("0.2.0")
        self.assertIn("\n\n## 0.2.0\n\n### Four\n\n- new\n\n## 0.1.0\n\n### One", page)
        self.assertTrue(page.endswith("### Three\n\n- more\n"))
        self.assertEqual([file.name for file in (self.work / "doc/changes").iterdir()],
                         ["README.md"])

    def test_links_lead_to_files(self):
        pages = [ROOT / "CHANGES.md", *(ROOT / "doc/changes").glob("*.md")]
        for page in pages:
            for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", page.read_text()):
                if not re.match(r"[a-z]+:", link):
                    self.assertTrue((page.parent / link).exists(), (page.name, link))

