# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/upkeep/renew: that a page that fails does not keep the others from being
measured, that short runs change nothing, and with what figures are made.
"""
from pathlib import Path

from tests.common.program import TESTS, ProgramTest
from upkeep.made import commit, made_with
from upkeep.measured import PAGES, Page
from upkeep.renew import Renewal, copy_tree

ROOT = TESTS.parent

# Writes data as the tools do; fails; writes data beyond their limits.
SCRIPTS = {
    "good": "#!/bin/sh\nsed -i s/old/new/ doc/$1.json\n",
    "bad": "#!/bin/sh\necho the reason\nexit 1\n",
    "beyond": "#!/bin/sh\nsed -i s/old/beyond/ doc/$1.json\nexit 3\n",
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
            self.file(name).write_text("old\n")
        self.said = []

    def renewal(self, pages, short=False):
        return Renewal(self.tree, pages, short, self.said.append)

    def file(self, name):
        return self.tree / f"doc/{name}.json"

    def data(self, name):
        return self.file(name).read_text()

    def pages(self):
        good = lambda name: (("contrib/good", name),)
        return {
            "first": Page("first.md", (("contrib/bad",), *good("first")),
                          (("contrib/bad",),)),
            "second": Page("second.md", good("second"), good("second")),
            "third": Page("third.md", good("third"), ())}

    def test_failing_pages_do_not_keep_the_others(self):
        pages = self.pages()
        self.assertEqual(self.renewal(pages).run(list(pages)), 1)
        # the first command failed: the second is not called
        self.assertEqual(self.data("first"), "old\n")
        self.assertEqual(self.data("second"), "new\n")
        report = (self.tree / "output/renew/report.txt").read_text()
        for words in ("first: FAILED, contrib/bad ended with exit code 1",
                      "second: renewed", "third: renewed"):
            self.assertIn(words, report)
        self.assertIn("the reason",
                      (self.tree / "output/renew/first.log").read_text())
        self.assertIn("FAILED: first", self.said[-1])

    def test_figures_beyond_their_limits_are_written(self):
        pages = {"second": Page("second.md", (("contrib/beyond", "second"),),
                                ())}
        self.assertEqual(self.renewal(pages).run(["second"]), 0)
        self.assertEqual(self.data("second"), "beyond\n")
        self.assertIn("second: renewed, limits are not met: see ",
                      (self.tree / "output/renew/report.txt").read_text())

    def test_made(self):
        made = made_with(self.tree)
        version = self.run_words([self.options.morula, "--version"]).stdout
        self.assertIn(version.strip(), made)
        self.assertIn("cores", made)

    def test_short_runs_change_nothing(self):
        pages = self.pages()
        before = {name: self.data(name) for name in pages}
        self.assertEqual(self.renewal(pages, True).run(list(pages)), 1)
        self.assertEqual({name: self.data(name) for name in pages}, before)
        copy = self.tree / "output/renew/tree/doc/second.json"
        self.assertEqual(copy.read_text(), "new\n")
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

    def test_every_page_has_its_tools(self):
        for name, page in PAGES.items():
            for words in (*page.full, *page.short):
                self.assertTrue((ROOT / words[0]).is_file(), words)
                help_text = self.run_words([ROOT / words[0], "--help"],
                                           cwd=ROOT).stdout
                for option in (w for w in words if w.startswith("--")):
                    self.assertIn(option, help_text, words[0])
            self.assertTrue((ROOT / "doc" / page.file).is_file(), name)

    def test_command_line(self):
        tool = ROOT / "contrib/upkeep/renew"
        listed = self.run_words([tool, "--list"]).stdout
        for name, page in PAGES.items():
            self.assertIn(f"doc/{page.file} ({name})", listed)
        self.assertIn("contrib/upkeep/cases verification --full --document", listed)
        self.assertNotIn("contrib/upkeep/cases verification/patch", listed)
        self.assertIn("contrib/upkeep/cases verification/patch",
                      self.run_words([tool, "--list", "--short"]).stdout)
        error = self.run_words([tool, "nopage"], code=2).stderr
        self.assertIn("there is no page 'nopage'; there are reproduction",
                      error)

    def test_short_run_of_the_cheapest_page(self):
        """The command itself, from its beginning to its report."""
        tree = self.work / "whole"
        copy_tree(ROOT, tree)
        (tree / "build").symlink_to(Path(self.options.morula).parent)
        said = self.run_words([tree / "contrib/upkeep/renew", "--short",
                               "parameters"]).stdout
        self.assertIn("parameters: its tools work", said)
        self.assertIn("renew: 1 of 1 pages", said)
        self.assertTrue((tree / "output/renew/report.txt").is_file())
        error = self.run_words([tree / "contrib/upkeep/renew", "--short",
                                "half-fixed-sphere", "nopage"], code=2).stderr
        self.assertIn("nopage", error)

