# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The page of contrib/report in a browser: its numbers are those of the run's
files, it is fit for keyboard, phone and darkness, and what is missing it says.
"""
import csv
import re

import numpy as np
from tests.common.program import SCENES
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from tests.common.report_test import KEYS, TABS, ReportTest


def contrast(one, other):
    """Of two colours as the browser writes them (WCAG 2, 1.4.3)."""
    def luminance(colour):
        parts = np.array([float(n) for n in
                          re.findall(r"[\d.]+", colour)[:3]]) / 255
        linear = np.where(parts <= 0.04045, parts / 12.92,
                          ((parts + 0.055) / 1.055)**2.4)
        return linear @ [0.2126, 0.7152, 0.0722]
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


class Page(ReportTest):
    def rows(self, selector):
        """The texts of a table's fields."""
        return self.browser.run(
            "return [...document.querySelectorAll(arguments[0] + ' tbody tr')]"
            ".map((row) => [...row.cells].map((c) => c.textContent.trim()))",
            selector)

    def assert_number(self, name, value):
        self.assertAlmostEqual(
            float(self.browser.text(name).replace(",", "")) / (value or 1),
            1 if value else 0, 3, name)

    def test_numbers(self):
        run, rows = self.run_read, self.run_read.statistics
        lineage = run.lineage
        sizes = {}
        for cell in run.cells(-1)["id"]:
            founder = lineage.ancestors(int(cell))[0]
            sizes[founder] = sizes.get(founder, 0) + 1
        grown = [f for f in range(lineage.founders) if sizes[f] > 1]
        largest = max(sizes.values())
        for name, value in {
                "steps": len(rows) - 1, "first-cells": rows["cells"][0],
                "last-cells": rows["cells"].iloc[-1],
                "last-day": rows["time"].iloc[-1],
                "last-volume": rows["total_volume"].iloc[-1],
                "founders": rows["cells"][0], "ever-lived": len(lineage),
                "divisions": rows["dividing"].sum(),
                "living": rows["cells"].iloc[-1],
                "undivided": lineage.founders - len(grown),
                "mean-clone": rows["cells"].iloc[-1] / rows["cells"][0],
                "latest-generation": run.cells(-1)["generation"].max(),
                "newton": rows["newton_iterations"].sum(),
                "linear": rows["linear_iterations"].sum(),
                "most-unknowns": rows["unknowns"].max(),
                "largest-residual": rows["residual"].max(),
                "rejected-steps": 0, "cells-per-edge": 60 / 12}.items():
            self.assert_number(name, float(value))
        words = re.fullmatch(r"(\d+) cells, of founder (\d+)",
                             self.browser.text("largest-clone"))
        self.assertEqual(int(words[1]), largest)
        self.assertEqual(sizes[int(words[2])], largest)

    def test_scene(self):
        keys = {row[0]: row[1:] for row in self.rows(".keys")}
        self.assertEqual(keys["Time/End time"], ["2", "1"])
        self.assertEqual(keys["Tissue/Cell spacing"], ["12", "10"])
        self.assertNotIn("Material/Poisson's ratio", keys)
        effects = {row[0]: row[1:] for row in self.rows(".effects")}
        self.assertEqual(effects["growth"][0], "off")
        self.assertEqual(effects["proliferation"][0], "on")
        self.assertEqual(effects["slip (Nitsche)"][0], "on")
        self.assertIn("Z <= 0", effects["slip (Nitsche)"][1])

    def test_timings(self):
        with open(self.run_read.directory / "timings.csv",
                  encoding="utf-8") as stream:
            written = {row["section"]: row for row in csv.DictReader(stream)}
        shown = {row[0]: row[1:] for row in self.rows(".timings")}
        rest = shown.pop("all else")
        self.assertEqual(set(shown), set(written))
        for section, row in written.items():
            self.assertEqual(int(shown[section][0].replace(",", "")),
                             int(row["calls"]))
            self.assertAlmostEqual(float(shown[section][1]),
                                   float(row["wall_seconds"]), delta=0.006)
            self.assertAlmostEqual(float(shown[section][2].strip(" %")),
                                   100 * float(row["share"]), delta=0.06)
        self.assertAlmostEqual(
            float(rest[2].strip(" %")) + sum(
                100 * float(row["share"]) for section, row in written.items()
                if section != "total"), 100, delta=0.1)
        self.click("tab-cost")
        bars = [bar.size["width"] for bar in self.browser.driver.find_elements(
            By.CSS_SELECTOR, ".timings .bar")]
        self.assertAlmostEqual(bars[0] / bars[-1], max(
            float(row["share"]) for section, row in written.items()
            if section != "total"), delta=0.02)

    def test_curves(self):
        """Every curve is drawn with its last value; lines are not flat."""
        self.click("tab-curves")
        rows = self.run_read.statistics
        for column in ("cells", "total_volume", "mean_energy_density"):
            words = self.browser.run(
                "return document.querySelector(arguments[0]).textContent",
                f"#curve-{column}").replace(",", "")
            numbers = [float(n) for n in re.findall(
                r"-?\d+\.?\d*(?:e[-+]\d+)?", words)]
            self.assertLess(np.abs(np.array(numbers) / rows[column].iloc[-1]
                                   - 1).min(), 1e-3, words)
        for picture in self.browser.driver.find_elements(
                By.CSS_SELECTOR, "#curves svg"):
            self.assertGreater(picture.size["height"], 100)

    def test_tree(self):
        """Every founder that is asked for has the cells of its clone."""
        run = self.run_read
        self.click("tab-lineage")
        for founder in (0, 57, run.lineage.founders - 1):
            self.browser.set("founder", founder, "change")
            clone = run.clone(founder)
            rows = self.rows("#tree-table")
            self.assertEqual([int(row[0]) for row in rows], clone.tolist())
            for row, cell in zip(rows, clone):
                self.assertEqual(int(row[1]), run.lineage.generation[cell])
                self.assertAlmostEqual(float(row[2]),
                                       run.lineage.birth_time[cell], 3)
                end = run.lineage.end_time[cell]
                if np.isfinite(end):
                    self.assertAlmostEqual(float(row[3]), end, 3)
                else:
                    self.assertEqual(row[3], "lives")
            living = len(set(clone) & set(run.lineage.living))
            self.assertEqual(
                self.browser.text("tree-words"), f"Founder {founder}: {living}"
                f" living cells after {living - 1} divisions.")
            lines = self.browser.run("return document.querySelectorAll("
                                     "'#tree line:not(.axis)').length")
            self.assertEqual(lines, len(clone) + living - 1)
        self.browser.set("founder", 10**9, "change")
        self.assertIn(f"Founder {run.lineage.founders - 1}:",
                      self.browser.text("tree-words"))
        self.click("another")
        self.click("largest")
        self.assertIn(f": {run.lineage.clone_sizes.max()} living",
                      self.browser.text("tree-words"))
        self.click("to-view")
        self.assertTrue(self.element("canvas").is_displayed())
        self.browser.wait("report.panel.show()")
        self.assertEqual(len(self.browser.run("return report.view.numbers")),
                         run.lineage.clone_sizes.max())

    def test_tabs_and_names(self):
        """By keyboard alone; every control says what it is."""
        tab = self.element("tab-overview")
        for name in TABS:
            section = self.element(name)
            self.assertTrue(section.is_displayed(), name)
            others = [n for n in TABS if n != name
                      and self.element(n).is_displayed()]
            self.assertEqual(others, [])
            for control in section.find_elements(
                    By.CSS_SELECTOR, "button, input, select, canvas"):
                self.assertTrue(control.accessible_name.strip(),
                                control.get_attribute("outerHTML"))
            tab.send_keys(Keys.ARROW_RIGHT)
            tab = self.browser.driver.switch_to.active_element
        self.assertEqual(tab.get_attribute("id"), "tab-overview")
        # from the tab on, every control that is enabled is reached
        self.click("tab-three")
        wanted = {control.get_attribute("id") for control in
                  self.element("view").find_elements(
                      By.CSS_SELECTOR, "button, input, select, canvas")
                  if control.is_enabled() and control.get_attribute("id")}
        reached = set()
        for _ in range(40):
            focus = self.browser.driver.switch_to.active_element
            reached.add(focus.get_attribute("id"))
            focus.send_keys(Keys.TAB)
        self.assertEqual(wanted - reached, set())

    def test_phone_and_darkness(self):
        self.browser.phone(375, 740)
        self.addCleanup(self.browser.driver.execute_cdp_cmd,
                        "Emulation.clearDeviceMetricsOverride", {})
        for scheme in ("dark", "light"):
            self.browser.driver.execute_cdp_cmd(
                "Emulation.setEmulatedMedia", {"features": [
                    {"name": "prefers-color-scheme", "value": scheme}]})
            for name in TABS:
                self.click(f"tab-{name}")
                self.assertLessEqual(self.browser.run(
                    "return document.documentElement.scrollWidth"), 375, name)
                colours = self.browser.run(
                    "const back = getComputedStyle(document.body)"
                    ".backgroundColor; return [...document.getElementById("
                    "arguments[0]).querySelectorAll('h2, dt, dd, td, li, "
                    "label, p')].map((e) => [getComputedStyle(e).color, "
                    "back, e.textContent.slice(0, 30)])", name)
                for front, back, text in colours:
                    self.assertGreater(contrast(front, back), 4.5, text)
            dark = contrast(colours[0][1], "rgb(0, 0, 0)") < 3
            self.assertEqual(dark, scheme == "dark")


class WithoutCells(Page):
    """Output/Formats = none: no view, all else."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.page, cls.run_read = cls.make_page(
            "none", SCENES.parent / "programs/small-cube.prm",
            {**KEYS, "Output/Formats": "none"})

    def test_numbers(self):
        self.click("tab-three")
        self.assertIn("Formats = none", self.browser.text("view-message"))
        self.assertFalse(self.element("view").is_displayed())
        self.assert_number("last-cells",
                           self.run_read.statistics["cells"].iloc[-1])

    def test_tree(self):
        self.click("tab-lineage")
        self.browser.set("founder", 3, "change")
        self.assertEqual([int(row[0]) for row in self.rows("#tree-table")],
                         self.run_read.clone(3).tolist())
        self.assertFalse(self.element("to-view").is_enabled())

    test_tabs_and_names = None
class WithoutWebGl(ReportTest):
    options_of_browser = ("--disable-3d-apis",)

    def tearDown(self):
        """Here the browser itself complains of WebGL."""
        for line in self.browser.complaints():
            self.assertIn("WebGL", line)

    def test_says_so(self):
        self.click("tab-three")
        self.assertIn("WebGL 2", self.browser.text("view-message"))
        self.assertFalse(self.element("view").is_displayed())
        self.click("tab-lineage")
        self.assertIn("living cells after", self.browser.text("tree-words"))
        self.assertFalse(self.element("to-view").is_enabled())

