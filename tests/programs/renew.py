#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/renew: what a page says of how it was made, that a page that fails
does not keep the others from being renewed, and that short runs change no page.
"""
import re
import shutil
from pathlib import Path

from program import TESTS, ProgramTest, main
from upkeep.measured import PAGES, Page
from upkeep.renew import COPIED, Renewal, commit

from tests.common.tables import renew

ROOT = TESTS.parent

MADE = "<!-- table made -->\n<!-- end -->\n"

# Renews a page as the tools do; fails; writes where it stands.
SCRIPTS = {
    "good": "#!/bin/sh\nsed -i s/old/new/ doc/$1.md\n",
    "bad": "#!/bin/sh\necho the reason\nexit 1\n",
    "beyond": "#!/bin/sh\nsed -i s/old/beyond/ doc/$1.md\nexit 3\n",
}


class Renew(ProgramTest):
    def setUp(self):
        super().setUp()
        self.tree = self.work / "tree"
        for name in ("contrib", "doc", "include", "prm", "source", "tests",
                     "build"):
            (self.tree / name).mkdir(parents=True)
        for name, text in SCRIPTS.items():
            (self.tree / "contrib" / name).write_text(text)
            (self.tree / "contrib" / name).chmod(0o755)
        (self.tree / "build/morula").symlink_to(self.options.morula)
        for name in ("first", "second", "third"):
            (self.tree / f"doc/{name}.md").write_text(f"# A\n\n{MADE}\nold\n")
        self.said = []

    def renewal(self, pages, short=False):
        return Renewal(self.tree, pages, short, self.said.append)

    def page(self, name):
        return (self.tree / f"doc/{name}.md").read_text()

    def pages(self):
        def after(root, renew_tables):
            self.assertTrue((root / "contrib/good").is_file())
            renew_tables(root / "doc/third.md", {"nowhere": "x"})

        good = lambda name: (("contrib/good", name),)
        return {
            "first": Page("first.md", (("contrib/bad",), *good("first")),
                          (("contrib/bad",),)),
            "second": Page("second.md", good("second"), good("second")),
            "third": Page("third.md", good("third"), (), after)}

    def test_failing_pages_do_not_keep_the_others(self):
        pages = self.pages()
        self.assertEqual(self.renewal(pages).run(list(pages)), 1)
        # the first command failed: nothing of it is believed
        self.assertIn("old", self.page("first"))
        self.assertIn(MADE, self.page("first"))
        self.assertIn("\nnew\n", self.page("second"))
        made, = re.findall(r"^\*Figures of .*\*$", self.page("second"), re.M)
        version = self.run_words([self.options.morula, "--version"]).stdout
        self.assertIn(version.strip(), made)
        self.assertIn("cores", made)
        # what is put in afterwards has no place there
        self.assertIn(MADE, self.page("third"))
        report = (self.tree / "output/renew/report.txt").read_text()
        for words in ("first: FAILED, contrib/bad ended with exit code 1",
                      "second: renewed", "third: FAILED", "no place"):
            self.assertIn(words, report)
        self.assertIn("the reason",
                      (self.tree / "output/renew/first.log").read_text())
        self.assertIn("FAILED: first, third", self.said[-1])

        # again, with the one that works: one line of how, the new one
        self.assertEqual(self.renewal(pages).run(["second"]), 0)
        self.assertEqual(self.page("second").count("*Figures of"), 1)

    def test_figures_beyond_their_limits_are_written(self):
        pages = {"second": Page("second.md", (("contrib/beyond", "second"),),
                                ())}
        self.assertEqual(self.renewal(pages).run(["second"]), 0)
        self.assertIn("\nbeyond\n", self.page("second"))
        self.assertIn("*Figures of", self.page("second"))
        self.assertIn("second: renewed, limits are not met: see ",
                      (self.tree / "output/renew/report.txt").read_text())

    def test_short_runs_change_no_page(self):
        pages = self.pages()
        before = {name: self.page(name) for name in pages}
        self.assertEqual(self.renewal(pages, True).run(list(pages)), 1)
        self.assertEqual({name: self.page(name) for name in pages}, before)
        copy = self.tree / "output/renew/tree/doc/second.md"
        self.assertIn("*Figures of", copy.read_text())
        self.assertIn("new", copy.read_text())
        self.assertTrue(any(line.startswith("third: has no short runs")
                            for line in self.said))

    def test_commit(self):
        """Of a tree with changes, without, and of one that is no
        repository."""
        tree = self.work / "repository"
        tree.mkdir()
        self.assertEqual(commit(tree / "nowhere"), "unknown commit")
        git = ["git", "-C", tree, "-c", "user.name=A", "-c", "user.email=a@b"]
        (tree / "source").mkdir()
        (tree / "source/a.cc").write_text("1")
        (tree / "doc.md").write_text("1")
        for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "One"]):
            self.run_words([*git, *words])
        self.assertRegex(commit(tree), r"^commit [0-9a-f]{7,}$")
        (tree / "doc.md").write_text("2")
        self.assertRegex(commit(tree), r"^commit [0-9a-f]{7,}$")
        (tree / "source/a.cc").write_text("2")
        self.assertRegex(commit(tree), r" with changes$")

    def test_every_page_has_its_places_and_tools(self):
        for name, page in PAGES.items():
            for words in (*page.full, *page.short):
                self.assertTrue((ROOT / words[0]).is_file(), words)
                help_text = self.run_words([ROOT / words[0], "--help"],
                                           cwd=ROOT).stdout
                for option in (w for w in words if w.startswith("--")):
                    self.assertIn(option, help_text, words[0])
            if name != "parameters":
                copy = shutil.copy(ROOT / "doc" / page.file, self.work)
                renew(Path(copy), {"made": "x"})

    def test_command_line(self):
        tool = ROOT / "contrib/renew"
        listed = self.run_words([tool, "--list"]).stdout
        for name, page in PAGES.items():
            self.assertIn(f"doc/{page.file} ({name})", listed)
        self.assertIn("contrib/verify --full --document", listed)
        self.assertNotIn("contrib/verify patch", listed)
        self.assertIn("contrib/verify patch",
                      self.run_words([tool, "--list", "--short"]).stdout)
        error = self.run_words([tool, "nopage"], code=2).stderr
        self.assertIn("there is no page 'nopage'; there are reproduction",
                      error)

    def test_short_run_of_the_cheapest_page(self):
        """The command itself, from its beginning to its report."""
        tree = self.work / "whole"
        for name in COPIED:
            shutil.copytree(ROOT / name, tree / name, symlinks=True)
        (tree / "build").symlink_to(Path(self.options.morula).parent)
        said = self.run_words([tree / "contrib/renew", "--short",
                               "parameters"]).stdout
        self.assertIn("parameters: its tools work", said)
        self.assertIn("renew: 1 of 1 pages", said)
        self.assertTrue((tree / "output/renew/report.txt").is_file())
        error = self.run_words([tree / "contrib/renew", "--short",
                                "half-fixed-sphere", "nopage"], code=2).stderr
        self.assertIn("nopage", error)


if __name__ == "__main__":
    main()
