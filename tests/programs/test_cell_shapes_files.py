# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/cell-shapes: its files and options, what it refuses; contrib/render
with --shapes. cell_shapes is about the regions themselves."""
import os
import re
import shutil
from pathlib import Path

import matplotlib.image
import numpy as np
from morula.expressions import rows_where
from morula.refusal import Refused
from morula.run import Run
from tests.common.program import SCENES, ProgramTest, overrides

from tests.common.shapes_file import ShapesFile

ROOT = Path(__file__).resolve().parents[2]

CUBE = SCENES.parent / "programs/small-cube.prm"


class Conditions(ProgramTest):
    def test_against_python(self):
        columns = {"x": np.array([-2.0, -1, 0, 3]), "id": np.arange(4)}
        x, number = columns["x"], columns["id"]
        for text, expected in {
                "x < 0 && id > 0": (x < 0) & (number > 0),
                "x<0||id==3": (x < 0) | (number == 3),
                "x": x > 0, "-x": x < 0, "x^2 - 2": x**2 > 2,
                "-2 < x <= 0 and id != 2": (-2 < x) & (x <= 0) & (number != 2),
                "abs(x) >= sqrt(4)": np.abs(x) >= 2, "1": x == x,
                "0": x != x, "(x + 3)/2*id > 1": (x + 3) / 2 * number > 1,
                "x/id > -1": np.divide(x, number, where=number > 0,
                                       out=np.full(4, -9.0)) > -1}.items():
            np.testing.assert_array_equal(
                rows_where(text, columns, "--where"), expected, text)
        for text in ("y > 0", "x >", "__import__('os')", "x if x", "[x]",
                     "'x'", "x < 0 ! id", ""):
            with self.assertRaisesRegex(Refused, "columns are x, id"):
                rows_where(text, columns, "--where")


class Files(ProgramTest):
    def setUp(self):
        super().setUp()
        self.output = self.work / "run"

    def grow(self, **keys):
        self.execute(CUBE, *overrides(keys), output=self.output)

    def tool(self, *arguments, code=0):
        return self.run_words([ROOT / "contrib/cell-shapes", self.output,
                               *arguments], code)

    def listed(self):
        """(time, file) of cell-shapes.pvd."""
        text = (self.output / "cell-shapes.pvd").read_text()
        return [(float(time), file) for time, file in re.findall(
            r'timestep="(.*?)" .*file="(.*?)"', text)]

    def made(self):
        return sorted(f.name for f in self.output.iterdir()
                      if "cell-shapes" in f.name)

    def test_states(self):
        """Single states, all, some cells; and columns from CSV and VTU."""
        self.grow(**{"Output/Formats": "csv, vtu"})
        self.tool("--time", "0.5")
        self.assertEqual(self.listed(), [(0.5, "cell-shapes-0001.vtu")])
        self.tool()
        self.assertEqual([time for time, _ in self.listed()], [0.5, 1])
        self.tool("--all")
        self.assertEqual(self.listed(), [(0.5 * i, f"cell-shapes-000{i}.vtu")
                                         for i in range(3)])
        run = Run(self.output)
        shapes = ShapesFile(self.output / "cell-shapes-0002.vtu")
        cells = run.cells(2)
        self.assertEqual({*shapes.columns},
                         {*cells, "sigma", "displacement", "region_volume",
                          "neighbours", "touches_surface"})
        for name, values in cells.items():
            np.testing.assert_array_equal(shapes.columns[name], values)
        self.tool("--where", "generation >= 1 && z > 30", "--output",
                  self.work / "some.vtu")
        some = ShapesFile(self.work / "some.vtu")
        kept = (cells["generation"] >= 1) & (cells["z"] > 30)
        self.assertGreater(kept.sum(), 5)
        for name, values in shapes.columns.items():
            np.testing.assert_array_equal(some.columns[name], values[kept])
        np.testing.assert_allclose(some.hull_volumes(),
                                   shapes.hull_volumes()[kept], rtol=1e-9)
        # regions of a run that was there before are not listed
        old = self.output / "cell-shapes-0000.vtu"
        os.utime(old, ns=(0, 0))
        self.tool()
        self.assertEqual([time for time, _ in self.listed()], [0.5, 1])

    def test_single_cell(self):
        """One cell, and two: no Voronoi diagram of their own."""
        for size in ("12, 12, 12", "12, 24, 12"):
            self.grow(**{"Tissue/Size": size, "Proliferation/Law": "none",
                         "Tissue/Center": "0, 0, 6",
                         "Time/End time": "0.125"})
            self.tool("--time", "0")
            shapes = ShapesFile(self.output / "cell-shapes-0000.vtu")
            np.testing.assert_allclose(shapes.hull_volumes(), 12.0**3,
                                       rtol=1e-9)
            np.testing.assert_array_equal(shapes.columns["neighbours"],
                                          len(shapes.corners) - 1)

    def test_refusals(self):
        self.assertIn("parameters.prm", self.tool(code=1).stderr)
        self.grow(**{"Time/End time": "0.5"})
        for words, texts in {
                ("--time", "0.3"): ("--time = '0.3'", "0, 0.5"),
                ("--time", "noon"): ("--time = 'noon'", "0, 0.5"),
                ("--time", "0.5", "--all"): ("--time", "--all"),
                ("--where", "speed > 1"): ("--where", "speed",
                                           "energy_density"),
                ("--where", "id < 0"): ("--where", "none of"),
                ("--all", "--output", "x.vtu"): ("--output", "single"),
                ("--output", "/nowhere/x.vtu"): ("/nowhere", "exists"),
                ("--output", "x.png"): ("x.png", ".vtu"),
                ("--shape",): ("--shape", "--help")}.items():
            said = self.tool(*words, code=1).stderr
            for text in texts:
                self.assertIn(text, said)
            self.assertNotIn("Traceback", said)
            self.assertEqual(self.made(), [])
        shutil.rmtree(self.output)
        self.grow(**{"Output/Formats": "none"})
        self.assertIn("Formats = none", self.tool(code=1).stderr)

    def test_damaged(self):
        """A message, exit code 1, and the files from before."""
        self.grow(**{"Output/Formats": "vtu", "Time/End time": "0.5"})
        self.tool()
        made = self.made()
        content = (self.output / "cell-shapes-0001.vtu").read_bytes()
        for name, text, words in (
                ("surface-0001.vtu", None, "not there"),
                ("surface-0001.vtu", "<VTKFile", "damaged"),
                ("cells-0001.vtu", "<VTKFile", "damaged")):
            file = self.output / name
            whole = file.read_bytes()
            file.unlink()
            if text is not None:
                file.write_text(text)
            said = self.tool(code=1).stderr
            self.assertIn(words, said)
            self.assertNotIn("Traceback", said)
            file.write_bytes(whole)
        # cells at one place
        self.grow(**{"Time/End time": "0.5"})
        file = self.output / "cells-0001.csv"
        lines = file.read_text().splitlines()
        rows = [line.split(",") for line in lines]
        at = rows[0].index("x")
        rows[7][at:at + 3] = rows[9][at:at + 3]
        (self.output / "cells.pvd").unlink(missing_ok=True)
        (self.output / "surface.pvd").unlink(missing_ok=True)
        file.write_text("\n".join(map(",".join, rows)) + "\n")
        self.assertIn("different places", self.tool(code=1).stderr)
        self.assertEqual(self.made(), made)
        self.assertEqual((self.output / "cell-shapes-0001.vtu").read_bytes(),
                         content)

    def picture(self, *arguments):
        file = self.work / "picture.png"
        self.run_words([ROOT / "contrib/render", self.output, "--width", "300",
                        "--output", file, *arguments])
        return matplotlib.image.imread(file)[:, :, :3]

    def test_pictures(self):
        """Polyhedra leave no gaps: seen along an axis the box fills its
        rectangle, but for the edges that are drawn dark."""
        self.grow(**{"Time/End time": "0.125", "Proliferation/Law": "none"})
        view = ("--time", "0", "--azimuth", "0", "--elevation", "0")
        for more in ((), ("--cut",), ("--cut", "--section")):
            image = self.picture("--shapes", "--field", "neighbours", *view,
                                 *more)
            part = image[150:300, 80:220]  # well inside the tissue
            self.assertLess((part.min(axis=2) > 0.95).mean(), 0.001)
            self.assertGreater(part.std(), 0.02)
        spheres = self.picture(*view)
        self.assertGreater(np.abs(spheres - self.picture("--shapes", *view)
                                  ).mean(), 0.005)
        said = self.run_words([ROOT / "contrib/render", self.output,
                               "--section"], 1).stderr
        self.assertIn("--section", said)

