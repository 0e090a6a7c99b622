# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/report without a browser: what it refuses, what it leaves out, what
it packs and fits. report_page and report_view open its page."""
import base64
import json
import re
import zlib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from morula.report import growth_fit, selection, shell
from morula.report.accuracy import BEST, FEWEST
from morula.report.packing import packed, quantised
from morula.run import Run
from PIL import Image
from tests.common.program import SCENES, ProgramTest, overrides

ROOT = Path(__file__).resolve().parents[2]

CUBE = SCENES.parent / "programs/small-cube.prm"


class Computed(ProgramTest):
    def test_packing(self):
        numbers = np.array([0, 1, 255, 256, 65535], dtype=np.uint16)
        content = zlib.decompress(base64.b64decode(
            packed(numbers, np.array([7, 9], dtype=np.uint8))))
        self.assertEqual(list(content[:5]), [0, 1, 255, 0, 255])
        self.assertEqual(list(content[5:10]), [0, 0, 0, 1, 255])
        self.assertEqual(list(content[10:]), [7, 9])
        values = np.linspace(-3, 5, 1000)
        steps = quantised(values, -3, 5, np.uint8)
        self.assertLess(np.abs(-3 + 8 * (steps / 255) - values).max(),
                        4.001 / 255)
        self.assertEqual(list(quantised([-9, 9], -3, 5, np.uint8)), [0, 255])
        self.assertEqual(list(quantised([4, 4], 4, 4, np.uint8)), [0, 0])

    def test_selection(self):
        run = SimpleNamespace(times=np.arange(11) * 0.5)
        counts = [1000] * 11

        def choose(wanted, limit):
            return selection.choose(run, counts, 10.0, ["volume"], wanted,
                                    limit)

        self.assertEqual(choose(None, 1e6).states, list(range(11)))
        self.assertEqual(choose(None, 1e6).words, [])
        some = choose(None, 35000)
        self.assertEqual(some.states, [0, 5, 10])
        self.assertTrue("3 are shown (day 0, 2.5, 5)", some.words[0])
        self.assertIn("--limit", some.words[0])
        few = choose(2, 1e6)
        self.assertEqual(few.states, [0, 10])
        self.assertIn("--states", few.words[0])
        last = choose(None, 10000)
        self.assertEqual((last.states, last.stride), ([10], 1))
        thin = choose(None, 3000)
        self.assertEqual((thin.states, thin.stride), ([10], 4))
        self.assertIn("every 4th", " ".join(thin.words))

    def test_shell(self):
        """A ball of a lattice, with a hole: what is deep inside, and only
        that, is no shell."""
        axis = np.arange(-200, 201, 10.0)
        grid = np.stack(np.meshgrid(axis, axis, axis), -1).reshape(-1, 3)
        radius = np.linalg.norm(grid, axis=1)
        kept = (radius < 200) & (radius > 40)
        grid, radius = grid[kept], radius[kept]
        found, depth = shell.of(grid, np.full(len(grid), 1000.0), False)
        self.assertEqual(depth, 3 * 1.5 * 10)
        # oblique to the voxels the layers are thinner: 26 um less half a voxel
        self.assertTrue(found[radius > 187].all())
        self.assertTrue(found[radius < 53].all())
        self.assertFalse(found[(radius > 115) & (radius < 125)].any())
        flat, _ = shell.of(grid, np.full(len(grid), 1000.0), True)
        self.assertTrue(flat.all())

    def test_fits(self):
        time = np.linspace(0, 5, 101)
        found = growth_fit.fit_growth(time, 7 * np.exp(0.36 * time))
        self.assertAlmostEqual(found.rate, 0.36, 12)
        self.assertAlmostEqual(found.factor, 7, 12)
        self.assertEqual((found.low, found.high, found.rows), (2, 4, 41))
        self.assertAlmostEqual(found.r2, 1, 12)
        self.assertTrue(found.exponential)
        straight = growth_fit.fit_growth(time, 1 + time)
        self.assertFalse(straight.exponential)
        self.assertAlmostEqual(straight.r2_line, 1, 12)
        self.assertIsNone(growth_fit.fit_growth(time, np.ones(101)))
        self.assertIsNone(growth_fit.fit_growth(time[:4], time[:4] + 1))
        # a shorter run: its second half
        short = growth_fit.fit_growth(time[:41], np.exp(time[:41]))
        self.assertEqual((short.low, short.high, short.rows), (1, 2, 21))

    def test_words_of_the_documentation(self):
        """What the page cites still stands there."""
        text = " ".join((ROOT / "doc/accuracy-and-cost.md").read_text()
                        .split())
        for words in ("four to seven cells to a grid cell's edge",
                      "Fewer than three roughen the surface",
                      "takes away most of the largest error"):
            self.assertIn(words, text)
        self.assertEqual((BEST, FEWEST), ((4, 7), 3))


class Report(ProgramTest):
    def setUp(self):
        super().setUp()
        self.output = self.work / "run"

    def grow(self, **keys):
        self.execute(CUBE, *overrides({"Time/End time": "1", **keys}),
                     output=self.output)

    def report(self, *arguments, code=0):
        return self.run_words(
            [ROOT / "contrib/report", self.output, "--morula",
             self.options.morula, *arguments], code)

    def page(self):
        return (self.output / "report.html").read_text()

    def about(self):
        return json.loads(re.search(
            r'id="about">(.*?)</script>', self.page())[1])

    def test_refusals(self):
        missing = self.report(code=1).stderr
        self.assertTrue("parameters.prm", missing)
        self.grow()
        for words, texts in {
                ("--states", "-1"): ("--states = '-1'", ">= 0"),
                ("--limit", "0"): ("--limit", "> 0"),
                ("--fields", "volume,speed"): ("speed", "energy_density"),
                ("--output", "/nowhere/x.html"): ("/nowhere", "exists"),
                ("--morula", "/nowhere/m"): ("--morula", "executable")}.items():
            said = self.report("--no-pictures", *words, code=1).stderr
            for text in texts:
                self.assertIn(text, said)
            self.assertFalse((self.output / "report.html").exists())
        self.assertEqual([f.name for f in self.output.iterdir()
                          if "html" in f.name], [])

    def test_damaged(self):
        """A message, exit code 1 and the old page; a run that has stopped
        has a page without what it lacks."""
        self.grow(**{"Output/Formats": "vtu"})
        self.report("--no-pictures", "--states", "1")
        page = self.page()
        for name, content, words in (
                ("cells-0001.vtu", None, "not there"),
                ("cells-0002.vtu", "<VTKFile", "damaged"),
                ("lineage.csv", "id,parent\n0,-1\n1", "lineage.csv"),
                ("statistics.csv", "step,time\n", "Has the run begun?")):
            file = self.output / name
            whole = file.read_bytes()
            file.unlink()
            if content is not None:
                file.write_text(content)
            said = self.report("--no-pictures", code=1).stderr
            self.assertIn(words, said)
            self.assertNotIn("Traceback", said)
            self.assertTrue(self.page() == page)
            file.write_bytes(whole)
        for name in ("lineage.csv", "timings.csv", "log.txt"):
            (self.output / name).unlink()
        self.report("--no-pictures", "--states", "1")
        self.assertIsNone(self.about()["lineage"])
        self.assertTrue("There is no timings.csv" in self.page())

    def test_choices(self):
        """Fewer fields and states, and the words that say so; no address of
        the network anywhere in the page."""
        self.grow(**{"Output/Interval": "0.25"})
        self.report("--no-pictures", "--states", "2", "--fields",
                    "sigma_xx,phase")
        about, run = self.about(), Run(self.output)
        self.assertEqual([f["name"] for f in about["view"]["fields"]],
                         ["sigma_xx", "phase"])
        self.assertEqual(about["view"]["fields"][0]["unit"], "kPa")
        self.assertEqual([s["time"] for s in about["view"]["states"]], [0, 1])
        page = self.page()
        self.assertTrue("Of 5 states that were written, 2 are shown (day 0, 1)"
                        in page)
        self.assertTrue("WebGLRenderer=" in page)
        self.assertTrue(re.search("Columns that are not here: [^<]*volume",
                                  page))
        # the cells as packed are those of the file
        state = about["view"]["states"][-1]
        self.assertEqual(state["cells"], len(run.cells(-1)["id"]))
        content = zlib.decompress(base64.b64decode(re.search(
            r'id="cells-1">(.*?)</script>', page)[1]))
        self.assertEqual(len(content), 8 * state["shown"])
        for found in re.findall(r'(?:src|href)="([^"]{0,40})', page):
            self.assertRegex(found, "^(data:|#)")
        self.assertRegex(page[:2000], "default-src 'none'; script-src( 'sha256-"
                         "[^']{44}'){14}; style-src 'unsafe-inline'; img-src "
                         "data:\"")
        self.assertFalse("@import" in page)

    def test_limit(self):
        """A page that may hold next to nothing shows some cells of the last
        state, and says so."""
        self.grow()
        self.report("--no-pictures", "--limit", "0.0005")
        view = self.about()["view"]
        self.assertEqual([s["time"] for s in view["states"]], [1])
        self.assertGreater(view["stride"], 1)
        state = view["states"][0]
        self.assertEqual(state["shown"], -(-state["cells"] // view["stride"]))
        words = f"every {selection.ordinal(view['stride'])} one is shown"
        self.assertTrue(words in self.page())

    def test_held(self):
        """With a size checkpoint, whom it holds is a colour, with a name."""
        self.grow(**{"Proliferation/Cell cycle/Size checkpoint": "1"})
        self.report("--no-pictures", "--states", "1")
        field = {f["name"]: f for f in self.about()["view"]["fields"]}[
            "held_at_checkpoint"]
        self.assertEqual((field["low"], field["high"]), (0, 1))
        self.assertEqual(field["names"], {"0": "not held", "1": "held"})
        content = zlib.decompress(base64.b64decode(re.search(
            r'id="field-held_at_checkpoint-0">(.*?)</script>',
            self.page())[1]))
        held = Run(self.output).cells(-1)["held_at_checkpoint"]
        self.assertGreater(held.sum(), 0)
        np.testing.assert_array_equal(list(content), 255 * held)

    def test_pictures(self):
        """Without the view: the run's own PNG or, without any, one that is
        drawn."""
        self.grow(**{"Output/Interval": "1"})
        self.report("--states", "0")
        self.assertIsNone(self.about()["view"])
        self.assertFalse("WebGLRenderer=" in self.page())
        self.assertLess(len(self.page()), 1_500_000)
        self.assertTrue("drawn by contrib/render" in self.page())
        self.assertTrue("data:image/jpeg;base64," in self.page())
        Image.new("RGB", (3000, 10), "red").save(self.output / "mine.png")
        self.report("--states", "0")
        self.assertTrue("mine.png" in self.page())
        self.assertFalse("drawn by contrib/render" in self.page())

    def test_flat(self):
        """Two dimensions: discs, areas, the flag that the view needs."""
        self.execute(SCENES / "proliferating-disc.prm", "-s",
                     "Output/Formats=csv", output=self.output)
        self.report("--no-pictures")
        view, run = self.about()["view"], Run(self.output)
        self.assertTrue(view["flat"])
        self.assertEqual(view["fields"][1]["unit"], "µm²")
        volumes = np.concatenate([run.cells(i)["volume"]
                                  for i in range(len(run.times))])
        np.testing.assert_allclose(
            view["radii"], np.sqrt([volumes.min() / np.pi,
                                    volumes.max() / np.pi]), rtol=1e-9)

