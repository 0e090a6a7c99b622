# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Text of a run that somebody else has made stays text on the page of
contrib/report, whatever stands in its files and in its directory's name: in a
browser, none of it becomes an element or runs, and nothing is missing."""
import shutil
from pathlib import Path

from PIL import Image
from tests.common.program import overrides

from tests.common.browser import Browser  # noqa: I100 (program.py finds it)
from tests.common.report_test import KEYS, ROOT, SCENE, TABS, ReportTest

# Each would run if it became an element. The second ends elements of the page,
# and begins a comment that would hide all that follows.
IMAGE = "<img src=data:x onerror=taken()>"
ENDS = f"</script></pre></td><!--<script>taken() {IMAGE}"
NAME = f"a<!--<script>b{IMAGE}\"'&amp;"
COLUMN = f"v\"><!--<script>{IMAGE}"
TYPE = f"$\\x {ENDS}"  # a name of a type, and no formula either


def add_types(output):
    """Cells of two types, whose names are hostile."""
    columns = {"cells-*.csv": {"type": 1}, "lineage.csv": {"type": 1},
               "statistics.csv": {f"cells_{TYPE}": 7, "cells_b": 8}}
    for pattern, added in columns.items():
        for file in output.glob(pattern):
            head, *rows = file.read_text().splitlines()
            head = ",".join([head, *added])
            values = "".join(f",{value}" for value in added.values())
            file.write_text("\n".join([head, *(row + values
                                              for row in rows), ""]))
    (output / "events.csv").write_text(
        f"time,id,event,from,to\n0.2,0,transition,b,{TYPE}\n")
    with open(output / "parameters.prm", "a", encoding="utf-8") as stream:
        stream.write(f"subsection Cell types\n  set Names = {TYPE}, b\nend\n")


class Text(ReportTest):
    @classmethod
    def setUpClass(cls):
        cls.page = cls.hostile_page()
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    @classmethod
    def hostile_page(cls):
        test = cls("setUp")
        test.work = cls.options.work / Path(__file__).stem
        test.work.mkdir(parents=True, exist_ok=True)
        plain, output = test.work / "plain", test.work / NAME
        test.execute(SCENE, *overrides({**KEYS, "Time/End time": "0.5",
                                        "Output/Formats": "csv"}),
                     output=plain)
        shutil.rmtree(output, ignore_errors=True)
        plain.rename(output)
        for file in output.glob("cells-*.csv"):
            file.write_text(file.read_text().replace("sigma_yz", COLUMN, 1))
        add_types(output)
        for name, text in {
                "log.txt": ENDS, "timings.csv": f"{ENDS},1,0.5,0.5",
                "parameters.prm": f"set Dimension{IMAGE[:4]}> = {ENDS}",
                }.items():
            with open(output / name, "a", encoding="utf-8") as stream:
                stream.write(f"{text}\n")
        Image.new("RGB", (30, 10), "red").save(output / f"{COLUMN}.png")
        page = test.work / "page.html"
        test.run_words([ROOT / "contrib/report", output, "--output", page,
                        "--morula", cls.options.morula,
                        "--fields", f"volume,{COLUMN},type"])
        return page

    def assert_text_alone(self):
        self.assertEqual(self.browser.run(
            "return document.querySelectorAll('[onerror]').length"),
            0)
        self.assertNotIn("taken", self.browser.run(
            "return [...document.scripts].filter((s) => !s.type)"
            ".map((s) => s.textContent).join()"))

    def test_text(self):
        """It is shown as it stands in the files, and no complaint is heard."""
        self.assert_text_alone()
        self.assertEqual(self.browser.run(
            "return [document.title, document.querySelector('h1').textContent,"
            " report.about.name]"), [f"{NAME} – Morula", NAME, NAME])
        words = self.browser.run("return document.body.textContent")
        for text in (ENDS, f"Dimension{IMAGE[:4]}>", f"{COLUMN}.png"):
            self.assertIn(text, words)
        for name in TABS:
            self.click(f"tab-{name}")
            self.assertTrue(self.element(name).is_displayed())

    def test_field(self):
        """A column with such a name is unpacked, drawn and labelled."""
        self.click("tab-three")
        self.browser.set("field", COLUMN, "change")
        self.browser.wait("report.panel.show()")
        self.assertIn(COLUMN, self.browser.text("bar"))
        self.assertEqual(self.browser.run(
            "return report.view.values.length === report.view.state.shown"),
            True)
        front = self.browser.run("return report.view.numbers.length")
        self.assertGreater(front, 50)
        self.assert_text_alone()

    def test_type(self):
        """Names of types are text at the colours, curves and the tree."""
        self.click("tab-three")
        self.browser.set("field", "type", "change")
        self.browser.wait("report.panel.show()")
        self.assertIn(TYPE, self.browser.text("bar"))
        self.click("tab-lineage")
        self.browser.set("founder", 0, "change")
        for place in ("tree-types", "tree-table", f"curve-cells_{TYPE}"):
            self.assertIn(TYPE, self.browser.text(place))
        self.assert_text_alone()

    def test_policy(self):
        """Even an element that got into the page could run nothing: the
        browser knows the page's own scripts by their digests."""
        self.browser.run(
            "window.taken = () => { window.robbed = true; };"
            "document.body.insertAdjacentHTML('beforeend', arguments[0]);"
            "const script = document.createElement('script');"
            "script.textContent = 'taken()';"
            "document.body.append(script);", IMAGE)
        self.browser.wait("new Promise((done) => setTimeout(done, 300))")
        self.assertIsNone(self.browser.run("return window.robbed"))
        refused = [line for line in self.browser.complaints()
                   if "Content Security Policy" in line]
        self.assertEqual(len(refused), 2, refused)

