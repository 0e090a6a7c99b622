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
    "--force-device-scale-factor=1", "--hide-scrollbars")


class Browser:
    """`driver` is Selenium's; use it in a with statement."""

    def __init__(self, *options, width=720, height=640, dark=False):
        programs = [shutil.which(name) for name in
                    ("chromium", "chromedriver")]
        if None in programs:
            raise RuntimeError("chromium or chromedriver is missing; "
                               "contrib/setup installs both")
        self.profile = tempfile.mkdtemp(prefix="morula-browser-")
        chosen = webdriver.ChromeOptions()
        chosen.binary_location = programs[0]
        for option in (*OPTIONS, *options, f"--window-size={width},{height}",
                       f"--user-data-dir={self.profile}"):
            chosen.add_argument(option)
        chosen.set_capability("goog:loggingPrefs",
                              {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(
            service=Service(programs[1]), options=chosen)
        self.driver.set_script_timeout(60)
        scheme = {"name": "prefers-color-scheme",
                  "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [scheme]})

    def __enter__(self):
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

    def wait(self, promise, *arguments):
        """The value of a promise."""
        return self.driver.execute_async_script(
            "const done = arguments[arguments.length - 1];"
            f"Promise.resolve({promise}).then(done);", *arguments)

    def text(self, element):
        return self.run("return document.getElementById(arguments[0])"
                        ".textContent.trim()", element)

    def set(self, element, value, event="input"):
        """As if the user had chosen a value."""
        self.run("const e = document.getElementById(arguments[0]);"
                 "e.value = arguments[1];"
                 "e.dispatchEvent(new Event(arguments[2]));",
                 element, str(value), event)

    def phone(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1,
            "mobile": True})

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


def image_of(png):
    """Red, green and blue (height, width, 3), 0 to 255, of a PNG: bytes, or a
    data: address."""
    if isinstance(png, str):
        png = base64.b64decode(png.partition(",")[2])
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=int)
