# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pages for new users work when they are followed to the letter: the commands
of "Your first tissue" in README.md, and those of the step programs' pages, in
a directory with the names of the tree."""
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
from morula.run import Run
from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent

STEPS = sorted((ROOT / "doc/steps").glob("step-*.md"))
# Further lines of the scenes that the pages' commands are tried with: whether they
# can be followed does not depend on the number of cells. The figures that the
# pages print are those of tests/steps and contrib/upkeep/step-pages.
COARSER = {
    "step-2": "subsection Tissue\n  set Cell spacing = 20\nend\n",
    "step-3": "subsection Tissue\n  set Cell spacing = 20\nend\n",
    "step-4": "subsection Tissue\n  set Cell spacing = 25\nend\n"
              "subsection Time\n  set End time = 1\nend\n",
    "step-5": "subsection Tissue\n  set Cell spacing = 20\nend\n",
    "step-6": "subsection Tissue\n  set Cell spacing = 40\nend\n"
              "subsection Grid\n  set Spacing = 100\nend\n"
              "subsection Time\n  set End time = 2.5\nend\n",
    "step-7": "subsection Tissue\n  set Cell spacing = 10\nend\n"
              "subsection Grid\n  set Spacing = 50\nend\n"}
COMMAND = re.compile(r"^    ((?:build|contrib)/\S(?:.*\\\n)*.*)$", re.M)


class Pages(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.work / "build").symlink_to(Path(self.options.morula).parent)
        (self.work / "contrib").symlink_to(ROOT / "contrib")
        shutil.copytree(ROOT / "prm", self.work / "prm")
        for step, lines in COARSER.items():
            with (self.work / f"prm/{step}.prm").open("a") as scene:
                scene.write(lines)

    def follow(self, command):
        print(command, flush=True)
        done = subprocess.run(command, shell=True, cwd=self.work, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, check=False)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}")
        return done.stdout

    def assert_pictures(self, number):
        """So many pictures with something in them."""
        found = list(self.work.glob("output/**/*.png"))
        self.assertEqual(len(found), number, found)
        for picture in found:
            self.assertGreater(picture.stat().st_size, 10000, picture)

    def assert_waist(self, surface):
        """From the held half up, the tissue becomes clearly narrower, and then
        wider again."""
        radius = np.hypot(surface["x"], surface["y"])
        height = np.floor(surface["z"] / 10).astype(int)
        widths = [radius[height == k].max() for k in range(height.max() + 1)]
        waist = int(np.argmin(widths[:12]))
        self.assertGreater(max(widths[:waist]), 1.08 * widths[waist])
        self.assertGreater(max(widths[waist:]), 1.25 * widths[waist])

    def test_first_tissue(self):
        text = (ROOT / "README.md").read_text()
        text = text[text.index("## Your first tissue"):]
        scene, commands = re.findall(r"^```\n(.*?)^```$", text,
                                     re.M | re.S)[:2]
        self.assertEqual(scene, (ROOT / "prm/bud.prm").read_text())
        (self.work / "bud.prm").write_text(scene)
        lines = commands.splitlines()
        self.assertEqual(len(lines), 4)
        said = [self.follow(line) for line in lines]
        self.assertIn("size checkpoint         on", said[0])
        self.assertIn("Finished: End time reached", said[1])
        self.assert_waist(Run(self.work / "output/bud").surface(-1))
        self.assert_pictures(1)
        self.assertIn("<html", (self.work / "output/bud/report.html")
                      .read_text()[:200])

    def test_steps(self):
        self.assertEqual(len(STEPS), 7)
        pictures = 0
        for page in STEPS:
            commands = COMMAND.findall(page.read_text())
            self.assertTrue(commands, page)
            for command in commands:
                with self.subTest(page=page.name, command=command):
                    self.follow(command)
                pictures += command.startswith("contrib/render")
        self.assertGreaterEqual(pictures, 4)
        self.assert_pictures(pictures)

