# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""doc/man: a page for each command that is installed, with all its options;
pages that readers of manuals take without a word; completion that knows them.
"""
import re
import shutil
import subprocess
import unittest

from tests.common.program import TESTS, ProgramTest
from upkeep.man_pages import FOLDER, help_of, names, parts_of, page_of
from upkeep.version_data import version

ROOT = TESTS.parent
COMPLETION = ROOT / "contrib/completion/morula"
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")


def plain(page):
    """A page without its marks."""
    return re.sub(r"\\f[BIR]|\\[,/]", "", page).replace("\\-", "-")


def words_of(page):
    """A page without what depends on Python's version: before 3.13 a value is
    named behind each form of an option, "-s KEY=VALUE, --set KEY=VALUE"."""
    return re.sub(r"(\\fB\\-\w\\fR) [A-Z=,]+(, \\fB)", r"\1\2",
                  re.sub(r"\s+", " ", page))


class ManPages(ProgramTest):
    def pages(self):
        return {name: (ROOT / FOLDER / f"{name}.1").read_text(encoding="utf-8")
                for name in names()}

    def test_files(self):
        self.assertEqual(sorted(file.stem for file in (ROOT / FOLDER).iterdir()),
                         sorted(names()))

    def test_options_and_examples(self):
        for name, page in self.pages().items():
            text = help_of(name, self.options.morula)
            with self.subTest(name):
                self.assertIn(f'"Morula {version()}"', page)
                self.assertLessEqual(set(OPTION.findall(text)),
                                     set(OPTION.findall(plain(page))))
                for example in parts_of(text)[1]:
                    self.assertIn(example.strip().replace("\\", "\\\\"), plain(page))
                self.assertNotRegex(plain(page).partition("SH NAME")[2],
                                    r"contrib/(?!python)")

    @unittest.skipUnless(shutil.which("help2man"), "help2man is missing")
    def test_pages_are_those_of_the_help(self):
        """contrib/upkeep/man-pages writes them."""
        for name, page in self.pages().items():
            made = page_of(name, self.options.morula)
            self.assertEqual(words_of(made), words_of(page), name)

    @unittest.skipUnless(shutil.which("mandoc") and shutil.which("lexgrog"),
                         "mandoc or man-db is missing")
    def test_readers_take_them(self):
        for name in names():
            file = ROOT / FOLDER / f"{name}.1"
            said = self.run_words(["mandoc", "-T", "lint", "-W", "warning", file])
            self.assertEqual(said.stdout + said.stderr, "", name)
            self.assertIn(f'"{name} - ', self.run_words(["lexgrog", file]).stdout)

    def complete(self, *words):
        """What bash would propose for the last of these words."""
        script = (f". {COMPLETION}; COMP_WORDS=(\"$@\"); "
                  "COMP_CWORD=$(($# - 1)); _morula \"$1\" \"${!#}\" "
                  "\"${COMP_WORDS[COMP_CWORD - 1]}\"; "
                  "printf '%s\\n' \"${COMPREPLY[@]}\"")
        done = subprocess.run(["bash", "-uc", script, "bash", *map(str, words)],
                              cwd=self.work, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, check=True)
        self.assertEqual(done.stderr, "")
        return sorted(done.stdout.split("\n")[:-1])

    def test_completion(self):
        morula = self.options.morula
        (self.work / "bud.prm").write_text("")
        (self.work / "budding.csv").write_text("")
        (self.work / "buds").mkdir()
        self.assertEqual(self.complete(morula, "bu"), ["bud.prm", "buds"])
        self.assertEqual(self.complete(morula, "--re"), ["--replace", "--resume"])
        self.assertEqual(self.complete(morula, "bud.prm", "-s", "Time/S"),
                         ["Time/Smallest step=", "Time/Step=", "Time/Stop at cells="])
        for typed in ("Time/End\\ t", '"Time/End t', "'Time/End t"):
            self.assertEqual(self.complete(morula, "bud.prm", "-s", typed),
                             ["Time/End time="])
        render = ROOT / "contrib/render"
        self.assertEqual(self.complete(render, "--mo"), ["--movie"])
        self.assertEqual(self.complete(render, "bu"), ["bud.prm", "budding.csv", "buds"])
        text = COMPLETION.read_text()
        for name in names():
            self.assertRegex(text, rf"(?m)^complete .*\b{name}\b")

