# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The page of contrib/report in a browser: cells are seen where they are, in their
colours; the controls do what they say; nothing is loaded."""
from pathlib import Path

import numpy as np
import pytest
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from tests.common.browser import Browser
from tests.common.program import SCENES

pytestmark = pytest.mark.release

REPORT = Path(__file__).resolve().parents[2] / "contrib/report"


@pytest.fixture(scope="module")
def cube(runs):
    return runs.run("cube", SCENES.parent / "programs/small-cube.prm", {
        "Time/End time": 2, "Time/Step": 0.25, "Output/Formats": "vtu", "Grid/Spacing": 60,
        "Proliferation/Cell cycle/Start": "together"})


@pytest.fixture(scope="module")
def browser(runs, cube):
    """With the page open; it complains of nothing and loads nothing."""
    page = runs.work / "page.html"
    runs.call([REPORT, cube.directory, "--output", page, "--no-pictures",
               "--morula", runs.options.morula])
    with Browser() as browser:
        browser.open(page)
        yield browser
        assert browser.complaints() == []
        assert browser.requests() == [page.resolve().as_uri()]


def element(browser, name):
    return browser.driver.find_element(By.ID, name)


def places(browser, cells):
    """Columns and rows of the cells' centres in the picture, distance to the
    viewer, and radii in pixels, for the camera of the start."""
    azimuth, elevation = np.radians([-60, 14])
    near = np.array([np.cos(elevation) * np.cos(azimuth),
                     np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.cross([0, 0, 1], near)
    right /= np.linalg.norm(right)
    about = browser.run("return report.view.about")
    middle = (np.array(about["low"]) + np.array(about["size"]) / 2)[:3]
    points = cells[["x", "y", "z"]].to_numpy() - middle
    pixel = browser.run("return report.view.pixel")
    height, width = browser.run("const c = report.view.canvas; return [c.height, c.width]")
    return (width / 2 + points @ right / pixel,
            height / 2 - points @ np.cross(near, right) / pixel, points @ near,
            np.cbrt(0.75 * cells["volume"].to_numpy() / np.pi) / pixel)


def seen(picture):
    return (picture < 250).any(axis=2)


def test_picture(browser, cube):
    """Cells are seen where they are, and nowhere else; the nearest one has the
    colour of its value."""
    cells = cube.cells(-1)
    browser.run("report.view.scene.children[1].visible = false")  # the axes
    across, down, near, radii = places(browser, cells)
    picture = browser.picture()
    rows, columns = np.indices(picture.shape[:2]) + 0.5
    expected = np.zeros(picture.shape[:2], dtype=bool)
    for x, y, r in zip(across, down, radii):
        expected |= (columns - x)**2 + (rows - y)**2 < r**2
    assert seen(picture).mean() > 0.1
    assert (seen(picture) ^ expected).sum() / expected.sum() < 0.01
    front = np.argmax(near + radii)
    shades = browser.run("return report.view.about.fields[0].shades")
    value = browser.run("const s = report.view.spheres.object.geometry;"
                        "return s.attributes.value.array[arguments[0]]", int(front))
    # seen straight on, a colour gets 105 % of its light
    colour = np.minimum(255, 1.05 * np.array(shades[3 * value:3 * value + 3]))
    assert np.abs(picture[int(down[front]), int(across[front])] - colour).max() < 12


def test_time(browser, cube):
    """Slider and play; the tissue grows, and another field has other colours."""
    areas = []
    for i in range(len(cube.times)):
        browser.set("time", i)
        browser.wait("report.view.show()")
        areas.append(seen(browser.picture()).sum())
        assert browser.text("time-shown") == (
            f"day {cube.times[i]:g}: {len(cube.cells(i)):,} cells")
    assert areas[-1] > 1.2 * areas[0]
    before = browser.picture()
    browser.set("field", "phase")
    browser.wait("report.view.show()")
    assert (browser.picture() != before).any()
    for words in ("Pause", "Play"):
        element(browser, "play").click()
        assert browser.text("play") == words


def test_cut(browser, cube):
    """What is cut away is on the side that the words name."""
    cells = cube.cells(-1)
    browser.set("time", len(cube.times) - 1)
    browser.wait("report.view.show()")
    whole = browser.picture()
    # the viewer stands at x > 0, y < 0, z > 0
    for axis, sign in (("x", ">"), ("y", "<"), ("z", ">")):
        browser.set("cut", axis)
        browser.set("place", 0.4)
        name, beyond, where = browser.text("place-shown").split()[:3]
        assert (name, beyond) == (axis, sign)
        cut = browser.run("return report.view.spheres.uniforms.cut.value.toArray()")
        kept = cells[["x", "y", "z"]] @ cut[:3] <= cut[3]
        clear = np.abs(cells[axis] - float(where)) > 0.1
        assert (kept == ((cells[axis] <= float(where)) == (sign == ">")))[clear].all()
        assert 0 < kept.sum() < len(cells)
        assert (browser.picture() != whole).any()
    browser.set("cut", "off")
    np.testing.assert_array_equal(browser.picture(), whole)


def test_camera(browser):
    """By buttons and by keys; 0 brings everything back."""
    home = browser.picture()
    canvas = element(browser, "canvas")
    for keys in (Keys.ARROW_LEFT, Keys.ARROW_DOWN, "+", "-"):
        canvas.send_keys(keys)
        assert (browser.picture() != home).any(axis=2).sum() > 500
        canvas.send_keys("0")
        np.testing.assert_array_equal(browser.picture(), home)
    pictures = set()
    for button in browser.driver.find_elements(By.CSS_SELECTOR, "[data-look]"):
        button.click()
        pictures.add(browser.picture().tobytes())
    assert len(pictures) == 4
