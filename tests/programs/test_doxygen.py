# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/upkeep/doxygen: no warning, pages whole; what is wrong makes it fail."""
import re
import shutil
from html import unescape
from urllib.parse import unquote

from tests.common.program import TESTS, ProgramTest
from upkeep.manual.search import escaped, identifier

ROOT = TESTS.parent


class Doxygen(ProgramTest):
    def setUp(self):
        super().setUp()
        self.assertTrue(shutil.which("doxygen"), "contrib/setup installs it")

    def make(self, root, output, code):
        return self.run_words([root / "contrib/upkeep/doxygen", "--output", output],
                              code)

    def copy(self):
        """All that the pages are made of, to be spoilt."""
        root = self.work / "copy"
        for name in ("contrib", "doc", "include"):
            shutil.copytree(ROOT / name, root / name)
        (root / "tests").mkdir()
        for name in ("README.md", "CONTRIBUTING.md", "tests/README.md",
                     "CMakeLists.txt"):
            shutil.copy(ROOT / name, root / name)
        return root

    def check_order_and_search(self, output):
        """Pages follow doc/README.md, and the search knows every key by its path
        and by each word of its name."""
        tree = (output / "navtreedata.js").read_text()
        places = [tree.index(f'"{name}.html"') for name in (
            "doc-install", "doc-steps-README", "doc-steps-step-1",
            "doc-steps-step-7", "doc-gallery", "doc-theory", "doc-faq",
            "CONTRIBUTING")]
        self.assertEqual(places, sorted(places))
        page = (output / "doc-parameters.html").read_text()
        letters = re.search(r'0: "([^"]*)"', (output / "search/searchdata.js")
                            .read_text())[1]
        paths = re.findall(r"^\| `([^`]+)` \|",
                           (ROOT / "doc/parameters.md").read_text(), re.M)
        self.assertGreater(len(paths), 100)
        for path in paths:
            name = path.rpartition("/")[2]
            for word in (path, *name.split()):
                file = f"search/all_{letters.index(word[0].lower()):x}.js"
                hits = [line for line in (output / file).read_text().splitlines()
                        if line.startswith(f"  ['{identifier(word)}")
                        and f"['{escaped(path)}'," in line]
                self.assertTrue(hits, (path, word))
            link = re.search(r"'\.\./doc-parameters\.html#([^']+)'", hits[0])[1]
            self.assertIn(f'id="{link}"', page)

    def test_no_warning_and_whole_pages(self):
        output = self.work / "doc"
        self.make(ROOT, output, 0)
        self.make(ROOT, output, 0)  # replaces what it has written itself
        index = (output / "index.html").read_text()
        self.assertIn("images/demo.png", index)
        theory = (output / "doc-theory.html").read_text()
        n = (ROOT / "doc/theory.md").read_text().count("```math")
        self.assertEqual(len(re.findall(r"\\tag\{", theory)), n)
        self.assertNotIn("```", theory)
        reference = (output / "doc-python-reference.html").read_text()
        for text in ("Scene.run", "Ctrl-C", "Function.map", "Lineage.tree",
                     "Run.cells", "common random numbers"):
            self.assertIn(text, reference)
        cases = (output / "doc-hard-cases.html").read_text()
        self.assertRegex(cases, r"disc, no extension\s*</td>")  # is measured
        self.assertNotIn("[Measured:", cases)
        self.assertFalse([*output.glob("*changes*")])
        self.assertIn('href="doc-theory.html#doc-theory-equation-4-2">(4.2)<',
                      (output / "classMorula_1_1Nitsche.html").read_text())

        self.check_order_and_search(output)

        missing, names = [], {}
        for page in sorted(output.glob("*.html")):
            text = page.read_text()
            names[page.name] = set(re.findall(r'(?:id|name)="([^"]+)"', text))
        for page in sorted(output.glob("*.html")):
            if not re.match(r"index|doc-|tests-|CONTRIBUTING|class|struct", page.name):
                continue
            for link in re.findall(r'(?:href|src)="([^"]+)"',
                                   page.read_text()):
                link = unquote(unescape(link))
                # Doxygen's own: to a list that has only private classes
                if re.match(r"[a-z]+:|#nested-classes$", link):
                    continue
                file, _, name = link.partition("#")
                target = output / file if file else page
                if not target.exists() or (
                        name and target.name in names
                        and name not in names[target.name]):
                    missing.append((page.name, link))
        self.assertEqual(missing, [])

    def test_wrong_comments_and_links_fail(self):
        root = self.copy()
        page = root / "doc/glossary.md"
        page.write_text(page.read_text() + "\n[no](theory.md#such-heading)\n")
        header = root / "include/morula/wrong.h"
        header.write_text("namespace Morula\n{\n  struct Bare\n  {};\n\n"
                          "  /** A sentence: doc/theory.md (1.1),\n   * (9.9).\n"
                          "   * @param b is none */\n"
                          "  void\n  twice(const int a);\n\n"
                          "  void\n  silent(const int a);\n}\n")
        said = self.make(root, self.work / "doc", 1).stderr
        self.assertIn("argument 'b' of command @param is not found", said)
        self.assertIn("doc-theory-equation-9-9", said)
        self.assertNotIn("doc-theory-equation-1-1", said)
        self.assertIn("struct Morula::Bare has no comment", said)
        self.assertIn("Morula::silent() has no comment", said)
        self.assertNotIn("twice() has no comment", said)
        self.assertIn("doc-theory-such-heading", said)

    def test_other_folders_are_left_alone(self):
        mine = self.work / "mine"
        mine.mkdir()
        (mine / "thesis.tex").write_text("text")
        self.make(ROOT, mine, 1)
        self.assertEqual([file.name for file in mine.iterdir()],
                         ["thesis.tex"])

