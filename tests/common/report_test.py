# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A page of contrib/report about a small run, open in a browser."""
from pathlib import Path

from morula.run import Run
from tests.common.program import SCENES, ProgramTest, overrides
from selenium.webdriver.common.by import By

from tests.common.browser import Browser

ROOT = Path(__file__).resolve().parents[2]

SCENE = SCENES.parent / "programs/small-cube.prm"
KEYS = {"Time/End time": "2", "Time/Step": "0.25", "Output/Formats": "vtu",
        "Output/Interval": "0.5", "Grid/Spacing": "60",
        "Proliferation/Cell cycle/Start": "together"}
TABS = ("overview", "three", "curves", "lineage", "cost", "accuracy")


class ReportTest(ProgramTest):
    """One run and one page for all tests, one browser for those of a
    class."""

    options_of_browser, pages = (), {}

    @classmethod
    def setUpClass(cls):
        if not cls.pages:
            cls.pages["cube"] = cls.make_page("cube", SCENE, KEYS)
        cls.page, cls.run_read = cls.pages["cube"]
        cls.browser = Browser(*cls.options_of_browser)
        cls.addClassCleanup(cls.browser.__exit__)

    @classmethod
    def make_page(cls, name, scene, keys):
        """Runs a scene; the page, and the run read."""
        test = cls("setUp")
        test.work = cls.options.work / cls.__module__.rsplit(".", 1)[-1]
        test.work.mkdir(parents=True, exist_ok=True)
        output = test.work / name
        test.execute(scene, *overrides(keys), output=output)
        page = test.work / f"{name}.html"
        test.run_words([ROOT / "contrib/report", output, "--output", page,
                        "--no-pictures", "--morula", cls.options.morula])
        return page, Run(output)

    def setUp(self):
        self.browser.open(self.page)

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual(set(self.browser.requests()),
                         {self.page.resolve().as_uri()})

    def element(self, name):
        return self.browser.driver.find_element(By.ID, name)

    def click(self, name):
        self.element(name).click()
