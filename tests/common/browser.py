# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A browser without a window, for tests of pages: Chromium, driven through
Selenium, with 3-D drawn by the processor."""
import base64
import io
import json
import shutil
import tempfile

import numpy as np
from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

# Nothing but the page may be loaded, by anybody's wish.
OPTIONS = (
    "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--disable-default-apps", "--disable-extensions",
    "--force-device-scale-factor=1", "--hide-scrollbars", "--window-size=720,640")


class Browser:
    """`driver` is Selenium's; use it in a with statement."""

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix="morula-browser-")
        chosen = webdriver.ChromeOptions()
        chosen.binary_location = shutil.which("chromium")
        for option in (*OPTIONS, f"--user-data-dir={self.profile}"):
            chosen.add_argument(option)
        chosen.set_capability("goog:loggingPrefs",
                              {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(
            service=Service(shutil.which("chromedriver")), options=chosen)
        self.driver.set_script_timeout(60)
        return self

    def __exit__(self, *_):
        self.driver.quit()
        shutil.rmtree(self.profile, ignore_errors=True)

    def open(self, file):
        """A page of the disk, until its scripts have started everything."""
        self.driver.get(file.resolve().as_uri())
        self.wait("report.ready")

    def run(self, script, *arguments):
        """The value of a script that returns it."""
        return self.driver.execute_script(script, *arguments)

    def wait(self, promise):
        """The value of a promise."""
        return self.driver.execute_async_script(
            f"Promise.resolve({promise}).then(arguments[0]);")

    def text(self, element):
        return self.run("return document.getElementById(arguments[0])"
                        ".textContent.trim()", element)

    def set(self, element, value):
        """As if the user had chosen a value."""
        self.run("const e = document.getElementById(arguments[0]);"
                 "e.value = arguments[1]; e.dispatchEvent(new Event('input'));",
                 element, str(value))

    def picture(self):
        """Red, green and blue (height, width, 3), 0 to 255, of the 3-D view."""
        address = self.run("report.view.draw();"
                           "return report.view.canvas.toDataURL('image/png')")
        content = base64.b64decode(address.partition(",")[2])
        return np.asarray(Image.open(io.BytesIO(content)).convert("RGB"), dtype=int)

    def complaints(self):
        """What the console says but for notes; says it once."""
        return [entry["message"] for entry in self.driver.get_log("browser")
                if entry["level"] in ("WARNING", "SEVERE")]

    def requests(self):
        """Addresses that were asked for, but for those of the browser's own
        first page and what an address itself holds; says them once."""
        found = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                found.append(message["params"]["request"]["url"])
        return [url for url in found if not url.startswith(("chrome", "data:"))]
