# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/import: label images and trackers' tables become scenes that run; what
is odd about them is said; and what the program says of surface files."""
import json

import numpy as np
import tifffile
from morula import Run
from morula.images.surface import Part, balls_around, contains
from tests.common.program import TESTS, ProgramTest, read_csv

from tests.common.cells_image import EDGE, INNER, hollow_ball

TOOL = TESTS.parent / "contrib/import"
COARSE, V = 4, "2,2,8"  # of the small 3-D image


def separate(n=4):
    """A mask of n^2 squares of 11 pixels with gaps of 3."""
    mask = np.zeros((14 * n + 4, 14 * n + 4), bool)
    for i in range(n):
        for j in range(n):
            mask[14 * i + 3:14 * i + 14, 14 * j + 3:14 * j + 14] = True
    return mask


def lined(n=4):
    """The same, with a label for each square."""
    square = np.arange(14 * n + 4) // 14
    return separate(n) * (n * square[:, None] + square + 1)


class Images(ProgramTest):
    def make(self, name, array, *words, code=0, **tiff):
        """What the tool says of an array as NumPy's file, or as TIFF."""
        file = self.work / name
        if tiff:
            tifffile.imwrite(file, array, **tiff)
        else:
            np.save(file, array)
        result = self.run_words([TOOL, file.name, "--again", *words],
                                code=code, cwd=self.work)
        return result.stdout if code == 0 else result.stderr

    def cells(self, name):
        return read_csv(self.work / name / "cells.csv")

    def test_hollow_ball(self):
        """From an anisotropic image with touching labels, a hole and a torn label
        to five days (in space to three): volumes, the surface's and the lumen's are
        the image's; the lumen stays open."""
        for dim, name, days in ((3, "ball.tif", 3), (2, "ring.tif", 5)):
            labels, voxel = hollow_ball(dim)
            said = self.make(name, labels, "--voxel",
                             ",".join(map(str, voxel[::-1])),
                             photometric="minisblack")
            self.assertIn("in several pieces", said)
            cells = self.cells(name[:-4])
            sizes = np.unique(labels[labels > 0], return_counts=True)[1]
            np.testing.assert_allclose(np.sort(cells["volume"]),
                                       np.sort(sizes) * voxel.prod(), 0.02)
            scene = self.work / name[:-4] / "scene.prm"
            self.execute(scene, "-s", f"Time/End time={days}",
                         output=self.work / f"run-{dim}")
            run = Run(self.work / f"run-{dim}")
            first, last = run.statistics.iloc[0], run.statistics.iloc[-1]
            total = sizes.sum() * voxel.prod()
            self.assertEqual(first["cells"], len(sizes))
            self.assertLess(abs(first["total_volume"] / total - 1), 1e-6)
            self.assertLess(abs(first["enclosed_volume"] / total - 1), 0.02)
            hole = [np.pi, 4 / 3 * np.pi][dim - 2] * INNER**dim
            self.assertLess(abs(first["lumen_volume"] / hole - 1), 0.05)
            self.assertEqual(last["time"], days)
            self.assertGreater(last["cells"], 1.2 * first["cells"])
            self.assertLess(abs(last["lumen_volume"] / first["lumen_volume"]
                                - 1), 1e-3)
            places = run.cells()[list("xyz"[:dim])].to_numpy() - EDGE / 2
            self.assertGreater(np.linalg.norm(places, axis=1).min(), INNER / 4)

    def test_other_images(self):
        """Each is imported, or refused with a word that says why."""
        small = hollow_ball(3, COARSE)[0]
        values = np.unique(small)
        index = np.searchsorted(values, small)
        n = len(values) - 1
        ring = hollow_ball(2)[0]
        for name, array, words, count, text in (
                ("u8", index.astype(np.uint8), V, n, ""),
                ("i32", index.astype(np.int32) * 1000003, V, n, ""),
                ("border", small[:, :18], V, None, "touch the border"),
                ("slice", ring[None], "0.5,0.5", 34, "one slice"),
                ("floats", small.astype(np.float32), V, n, "but whole"),
                ("negative", np.where(small > 0, small.astype(int), -1), V, n,
                 "below 0"),
                ("mask", separate(), "1,1", 16, "16 parts"),
                ("lines", lined(), "1,1", 16, "--fill-gaps gives")):
            with self.subTest(name):
                said = self.make(f"{name}.npy", array, "--voxel", words)
                self.assertIn(text, said)
                if count:
                    self.assertEqual(len(self.cells(name)), count)
                self.execute(self.work / name / "scene.prm", "--explain")
        for name, array, text in (
                ("whole-mask", small > 0, "a mask with a single part"),
                ("rgb", np.zeros((40, 40, 3), np.uint8), "colour picture"),
                ("intensity", small + 0.25, "segment it first"),
                ("nan", np.where(small > 0, small, np.nan), "fractions"),
                ("complex", small.astype(complex), "complex128"),
                ("4d", np.stack([small, small]), "4 axes"),
                ("1d", np.arange(9), "shape is (9,)"),
                ("empty", np.zeros_like(small), "no cell"),
                ("nothing", small[:0], "shape is (0"),
                ("words", np.array([["a"]]), "type <U1")):
            with self.subTest(name):
                self.assertIn(text, self.make(f"{name}.npy", array, "--voxel",
                                              V, code=1))
                self.assertFalse((self.work / name).exists())

    def test_lines_are_filled_on_request(self):
        self.make("lines.npy", lined(), "--voxel", "1,1", "--fill-gaps")
        filled = self.cells("lines")["volume"]
        self.assertEqual(len(filled), 16)
        # an inner cell gets half of the gaps around it: 14 by 14
        self.assertLess(abs(filled.max() / 14**2 - 1), 0.1)

    def test_voxels(self):
        """Of OME, ImageJ and the option; and what these may not be."""
        small = hollow_ball(3, COARSE)[0]
        about = {"axes": "ZYX", "PhysicalSizeX": 2.0, "PhysicalSizeY": 2000.0,
                 "PhysicalSizeYUnit": "nm", "PhysicalSizeZ": 8.0}
        self.make("ome.tif", small, ome=True, metadata=about)
        self.make("imagej.tif", small, imagej=True, resolution=(0.5, 0.5),
                  metadata={"axes": "ZYX", "spacing": 8.0, "unit": "um"})
        self.make("option.npy", small, "--voxel", V)
        for name in ("ome", "imagej"):
            for column in ("x", "z", "volume"):
                np.testing.assert_allclose(self.cells(name)[column],
                                           self.cells("option")[column])
        for words, text in (([], "does not say it"),
                            (["--voxel", "1,0,1"], "3 numbers > 0"),
                            (["--voxel", "1,1"], "order x,y,z"),
                            (["--voxel", "a,b,c"], "3 numbers > 0")):
            self.assertIn(text, self.make("none.npy", small, *words, code=1))

    def test_channels_times_and_types(self):
        small = hollow_ball(3, COARSE)[0]
        bright = np.where(np.indices(small.shape)[2] > 24, 200, 10)
        both = np.stack([small, bright.astype(np.uint16)])
        about = {"ome": True, "metadata": {"axes": "CZYX"}}
        self.assertIn("--channel", self.make("two.tif", both, "--voxel", V,
                                             code=1, **about))
        said = self.make("two.tif", both, "--voxel", V, "--channel", "0",
                         "--marker-channel", "1", **about)
        self.assertIn("are positive", said)
        text = (self.work / "two/cells.csv").read_text().splitlines()
        for line in text[1:]:
            x, *_, kind = line.split(",")
            if abs(float(x) - EDGE / 2) > 10:
                self.assertEqual(kind, "positive" if float(x) > EDGE / 2
                                 else "negative")
        self.assertIn("--frame", self.make(
            "times.tif", both[:1].repeat(2, 0), "--voxel", V, code=1, ome=True,
            metadata={"axes": "TZYX"}))
        table = self.write("types.csv", "label,type\n" + "".join(
            f"{label},{'ab'[label % 2]}\n" for label in np.unique(small)))
        self.make("typed.npy", small, "--voxel", V, "--types", table)
        found = json.loads(self.execute(self.work / "typed/scene.prm",
                                        "--explain=json").stdout)
        self.assertEqual([kind["name"] for kind in found["types"]], ["a", "b"])
        self.assertEqual(sum(kind["founders"] for kind in found["types"]),
                         found["cells"])

    def test_table(self):
        rng = np.random.default_rng(2)
        grid = np.stack(np.meshgrid(*[np.arange(5) * 10.0] * 3), -1).reshape(
            -1, 3) + rng.uniform(-1, 1, (125, 3))
        lines = ["LABEL,POSITION_X,POSITION_Y,POSITION_Z,FRAME,RADIUS",
                 "Label,X,Y,Z,Frame,Radius", "label,(um),(um),(um),,(um)"]
        lines += [f"{i},{x},{y},{z},{frame},6" for frame in (0, 3)
                  for i, (x, y, z) in enumerate(grid + 100 * frame)]
        self.write("spots.csv", "\n".join(lines) + "\n")
        words = [TOOL, "spots.csv", "--again"]
        self.assertIn("2 times", self.run_words(words, 1, self.work).stderr)
        said = self.run_words([*words, "--frame", "1"], 0, self.work).stdout
        self.assertIn("2 lines hold no numbers", said)
        cells = self.cells("spots")
        np.testing.assert_allclose(cells["x"], grid[:, 0] + 300, rtol=1e-7)
        np.testing.assert_allclose(cells["volume"], 4 / 3 * np.pi * 216)
        self.execute(self.work / "spots/scene.prm", "--explain")

    def test_cover_of_a_cavity(self):
        """Balls hold all of a bent cavity and nothing of the outer surface."""
        angle = np.linspace(0.3, 2 * np.pi - 0.3, 300)[:, None]
        middle = np.hstack([np.cos(angle), np.sin(angle)]) * 50
        inner = Part(np.vstack([middle * 1.1, middle[::-1] * 0.9]), None, -1.0)
        outer = Part(np.vstack([middle * 1.4, middle[::-1] * 0.6]), None, 1.0)
        balls = balls_around(inner, [outer])
        for points, wanted in ((inner.vertices, True), (outer.vertices, False)):
            held = np.any([np.linalg.norm(points - centre, axis=1) < radius
                           for centre, radius in balls], axis=0)
            self.assertTrue((held == wanted).all())
        square = Part(np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), None, 1.0)
        self.assertEqual(list(contains(square, np.array([[0.5, 0.5],
                                                         [1.5, 0.5]]))),
                         [True, False])

    def test_surface_files(self):
        """Cells outside are refused with their number, and files that hold no
        polygons with the reason."""
        cells = "x,y\n" + "".join(f"{x},{y}\n" for x in range(5, 95, 10)
                                  for y in range(5, 95, 10))
        self.write("cells.csv", cells)
        square = "POLYGON((0 0, {0} 0, {0} 90, 0 90, 0 0))"
        scene = self.write("scene.prm", """set Dimension = 2
subsection Tissue
  set Shape = points
  set Points file = cells.csv
  set Points surface = outline.wkt
end
subsection Grid
  set Spacing = 30
end
""")
        for text, words in (
                (square.format(50), ["36 of 81 cells stand outside"]),
                ("POLYGON((0 0, 90 90, 90 0, 0 90, 0 0))", ["has none that can"]),
                ("POINT(1 2)", ["MULTIPOLYGON"]), ("", ["MULTIPOLYGON"]),
                ("POLYGON((0 0, 9 9", ["It cannot be read as such"]),
                ("POLYGON((0 0, 9", ["At '9' there are not two"])):
            self.write("outline.wkt", text)
            said = self.execute(scene, code=1).stderr
            for word in ("Tissue/Points surface", *words):
                self.assertIn(word, said)
        self.write("outline.wkt", square.format(90))
        explained = json.loads(self.execute(scene, "--explain=json").stdout)
        self.assertEqual(explained["boundary points"], 36)  # 360 um by 10
        self.assertIn(".wkt", self.execute(
            scene, "-s", "Tissue/Points surface=cells.csv", code=1).stderr)

