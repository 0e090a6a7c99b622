# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Types of cells on the page of contrib/report, in a browser: their names at
the colours, their curves, and in the tree the type of every cell at every time,
as lineage.csv and events.csv have it."""
import csv

import numpy as np
from matplotlib.colors import to_rgb
from morula.draw.colours import OF_TYPES
from tests.common.program import SCENES

from tests.common.browser import Browser, image_of  # noqa: I100 (program.py finds it)
from tests.common.report_test import ReportTest

KEYS = {"Time/End time": "1.5", "Output/Interval": "0.5"}
NAMES = ["transit", "stem", "resting"]


class Types(ReportTest):
    @classmethod
    def setUpClass(cls):
        cls.page, cls.run_read = cls.make_page(
            "types", SCENES / "cell-types.prm", KEYS)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def rows_of(self, name):
        with open(self.run_read.directory / name,
                  encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_colours(self):
        """Each type has its own, with its name in the legend; the cells in
        them are those of the file."""
        self.click("tab-three")
        self.browser.set("field", "type", "change")
        self.browser.wait("report.panel.show()")
        self.assertEqual(self.browser.text("bar"), "Type" + "".join(NAMES))
        found = self.browser.run(
            "return [...document.querySelectorAll('#bar .swatch')]"
            ".map((e) => e.style.background)")
        expected = [tuple(round(255 * part) for part in to_rgb(colour))
                    for colour in OF_TYPES[:3]]
        self.assertEqual(found, [f"rgb{colour}" for colour in expected])
        values = self.browser.run("return [...report.view.values]")
        types = self.run_read.cells(-1)["type"]
        self.assertEqual(set(types), {0, 1, 2})
        # of 255 steps from the first to the last type
        self.assertEqual(values, [round(127.5 * t) for t in types])

    def test_flat_discs(self):
        """The page of a 2-D run opens with the types, as discs in the colours of
        the legend, which a drag moves and does not turn."""
        self.click("tab-three")
        self.browser.wait("report.panel.show()")
        self.assertEqual(self.browser.run(
            "return document.getElementById('field').value"), "type")
        self.assertEqual(self.browser.run(
            "return [...document.querySelectorAll('[data-look]')]"
            ".filter((e) => !e.hidden).map((e) => e.dataset.look)"), ["home"])
        self.assertFalse(self.browser.run(
            "return report.view.camera.controls.enableRotate"))
        picture = image_of(self.browser.run("return report.view.picture()"))
        cells = self.run_read.cells(-1)
        about = self.browser.run("return report.about.view")
        pixel = self.browser.run("return report.view.camera.pixel")
        middle = np.array(about["low"]) + np.array(about["size"]) / 2
        height, width = picture.shape[:2]
        columns = (width / 2 + (cells["x"] - middle[0]) / pixel).astype(int)
        rows = (height / 2 - (cells["y"] - middle[1]) / pixel).astype(int)
        wanted = np.array([[round(255 * part) for part in to_rgb(colour)]
                           for colour in OF_TYPES[:3]])[cells["type"]]
        off = np.abs(picture[rows, columns].astype(int) - wanted).max(axis=1)
        # but for middles that another disc covers
        self.assertGreater((off <= 1).mean(), 0.95)

    def test_curves(self):
        words = self.browser.text("curve-cells_transit")
        last = self.rows_of("statistics.csv")[-1]
        self.assertIn("Day 1.5: " + "; ".join(
            f"{name}: {last['cells_' + name]}" for name in NAMES) + ".",
            words)
        lines = self.browser.run(
            "return new Set([...document.querySelectorAll("
            "'#curve-cells_transit path')].map((e) => e.style.stroke)"
            ".filter((c) => c.includes('series'))).size")
        self.assertEqual(lines, 3)

    def test_states(self):
        """The page knows each cell's type at the time of each state."""
        for i, time in enumerate(self.run_read.times):
            cells = self.run_read.cells(i)
            found = self.browser.run(
                "return arguments[0].map((id) => report.lineage.typeAt(id, "
                "arguments[1]))", cells["id"].tolist(), time)
            self.assertEqual(found, [NAMES[t] for t in cells["type"]])

    def test_tree(self):
        """A dot for each change, and every type in words."""
        self.click("tab-lineage")
        self.assertIn("transitstemresting", self.browser.text("tree-types"))
        changes = self.rows_of("events.csv")
        births = {int(row["id"]): NAMES[int(row["type"])]
                  for row in self.rows_of("lineage.csv")}
        lineage = self.run_read.lineage
        twice = [row["id"] for row in changes if row["from"] == "resting"]
        for cell in (int(twice[0]), int(changes[-1]["id"])):
            founder = int(lineage.founder[cell])
            self.browser.set("founder", founder, "change")
            clone = self.run_read.clone(founder).tolist()
            mine = [row for row in changes if int(row["id"]) in clone]
            dots = self.browser.run("return document.querySelectorAll("
                                    "'#tree circle').length")
            self.assertEqual(dots, len(mine))
            words = self.browser.run(
                "return [...document.querySelectorAll('#tree-table tbody tr')]"
                ".map((row) => row.cells[4].textContent)")
            self.assertEqual(
                [[part.split()[0] for part in text.split(",")]
                 for text in words],
                [[births[i], *(row["to"] for row in mine
                               if int(row["id"]) == i)] for i in clone])
            pieces = self.browser.run("return document.querySelectorAll("
                                      "'#tree line.of-type').length")
            self.assertEqual(pieces, len(clone) + len(mine))

