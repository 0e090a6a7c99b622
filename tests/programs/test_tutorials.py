# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The pages that people follow from begin to end, run as they stand: what they
claim, they assert."""
import json
import os
import re
import subprocess
from pathlib import Path

import matplotlib
from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent
BLOCK = re.compile(r"<!-- run: ([\w-]+) -->\n```(\w+)\n(.*?)^```", re.S | re.M)


class Tutorials(ProgramTest):
    def setUp(self):
        super().setUp()
        matplotlib.use("Agg")
        for name in ("contrib", "doc"):
            (self.work / name).symlink_to(ROOT / name)
        before = Path.cwd(), os.environ["PATH"]
        os.chdir(self.work)
        self.addCleanup(os.chdir, before[0])
        # a scene without `morula=` takes the program of the tree
        build = Path(self.options.morula).parent
        os.environ["PATH"] = f"{build}:{before[1]}"
        self.addCleanup(os.environ.__setitem__, "PATH", before[1])

    def follow(self, page):
        """Runs the marked blocks of a page in their order."""
        names = {}
        blocks = BLOCK.findall((ROOT / "doc" / page).read_text())
        self.assertTrue(blocks)
        for name, language, text in blocks:
            if language == "sh":
                subprocess.run(["bash", "-euc", text], check=True)
            else:
                exec(compile(text, f"{page}, {name}", "exec"), names)
        return names

    def test_first_tissue(self):
        names = {}
        book = json.loads((ROOT / "doc/first-tissue.ipynb").read_text())
        cells = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
        self.assertGreater(len(cells), 5)
        for number, cell in enumerate(cells):
            self.assertEqual(cell["outputs"], [], "measured numbers are not kept")
            exec(compile("".join(cell["source"]), f"cell {number}", "exec"),
                 names)
        self.assertTrue(names["run"].finished)
        picture = names["run"].show("energy_density", panels=1)._repr_png_()
        self.assertEqual(picture[1:4], b"PNG")

    def test_from_an_image(self):
        names = self.follow("from-an-image.md")
        self.assertEqual(names["scene"]["Tissue/Points surface"],
                         "surface.off")

    def test_fit_a_spheroid(self):
        names = self.follow("fit-a-spheroid.md")
        # kept runs: the same point again, without a run
        again = names["model"].map([names["prior"][names["best"]]])
        self.assertLess(abs(again[0] - names["found"][names["best"]]).max(),
                        1e-12)

