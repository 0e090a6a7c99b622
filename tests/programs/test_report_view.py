# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The 3-D view of contrib/report in a browser: it shows the cells of the run's
files, every control does what it says, and nothing is loaded."""
import base64

import numpy as np
from matplotlib.colors import to_rgb
from morula.draw.colours import NAMED, palette_of, style_of
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from tests.common.browser import image_of  # noqa: I100 (program.py finds it)
from tests.common.report_test import ReportTest

BACKGROUND = 255  # of the light page


class View(ReportTest):
    """The cells in 3-D."""

    def setUp(self):
        super().setUp()
        self.click("tab-three")
        self.settle()

    def settle(self):
        """Waits for what the panel loads; the last call wins there too."""
        self.browser.wait("report.panel.show()")

    def picture(self):
        return image_of(self.browser.run("return report.view.picture()"))

    def choose(self, field):
        self.browser.set("field", field, "change")
        self.settle()

    def drawn(self):
        return self.browser.run("return report.view.numbers")

    def seen(self, picture):
        """Where something other than the background is."""
        return (picture != BACKGROUND).any(axis=2)

    def projected(self, cells):
        """Columns and rows of the cells' centres, distance to the viewer, and
        pixels of a radius of 1 um, from the camera's angles."""
        azimuth, elevation = np.radians([-60, 14])
        near = np.array([np.cos(elevation) * np.cos(azimuth),
                         np.cos(elevation) * np.sin(azimuth),
                         np.sin(elevation)])
        right = np.cross([0, 0, 1], near)
        right /= np.linalg.norm(right)
        up = np.cross(near, right)
        about = self.browser.run("return report.about.view")
        middle = np.array(about["low"]) + np.array(about["size"]) / 2
        points = np.array([cells[c] for c in "xyz"]).T - middle
        pixel = self.browser.run("return report.view.camera.pixel")
        height, width = self.browser.run(
            "const c = report.view.canvas; return [c.height, c.width]")
        return (width / 2 + points @ right / pixel,
                height / 2 - points @ up / pixel, points @ near, 1 / pixel)

    def radii(self, cells):
        return np.cbrt(0.75 * cells["volume"] / np.pi)

    def test_packed_data(self):
        """Every state that is unpacked in the page is that of the files."""
        run = self.run_read
        about = self.browser.run("return report.about.view")
        self.assertEqual([s["time"] for s in about["states"]],
                         list(run.times))
        for i, state in enumerate(about["states"]):
            self.browser.set("time", i)
            cells = run.cells(i)
            for field in about["fields"]:
                self.choose(field["name"])
                values = np.array(self.browser.run(
                    "return [...report.view.values]"))
                step = (field["high"] - field["low"]) / 255
                exact = np.clip(cells[field["name"]], field["low"],
                                field["high"])
                self.assertLessEqual(np.abs(
                    field["low"] + step * values - exact).max(),
                    0.51 * step + 1e-6)
            places = np.array(self.browser.run(
                "return [...report.view.cells.places]")).reshape(-1, 4)
            for k, name in enumerate("xyz"):
                found = about["low"][k] + about["size"][k] * (
                    places[:, k] / 65535)
                self.assertLess(np.abs(found - cells[name]).max(),
                                about["size"][k] / 65535 + 1e-4)
            low, high = about["radii"]
            found = low + (high - low) * places[:, 3] / 65535
            self.assertLess(np.abs(found - self.radii(cells)).max(),
                            0.51 * (high - low) / 255)
            self.assertEqual(self.browser.run("return [...report.view.ids]"),
                             cells["id"].tolist())
            self.assertEqual(
                self.browser.text("time-shown"),
                f"day {run.times[i]:g}: {len(cells['id']):,} cells")

    def test_outline(self):
        """Cells are seen where they are, and nowhere else."""
        cells = self.run_read.cells(-1)
        across, down, _, scale = self.projected(cells)
        picture = self.picture()
        rows, columns = np.indices(picture.shape[:2]) + 0.5
        expected = np.zeros(picture.shape[:2], dtype=bool)
        for x, y, r in zip(across, down, scale * self.radii(cells)):
            expected |= (columns - x)**2 + (rows - y)**2 < r**2
        found = self.seen(picture)
        self.assertGreater(found.mean(), 0.2)
        self.assertLess((found ^ expected).sum() / expected.sum(), 0.01)
        # and the browser itself shows that picture
        shot = image_of(self.element("canvas").screenshot_as_png)
        share = self.seen(shot).mean() / found.mean()
        self.assertLess(abs(share - 1), 0.1)

    def test_colours(self):
        """The cell nearest to the viewer has the colour of its value."""
        cells = self.run_read.cells(-1)
        across, down, near, _ = self.projected(cells)
        front = np.argmax(near + self.radii(cells))
        place = int(down[front]), int(across[front])
        about = self.browser.run("return report.about.view")
        pictures = []
        for field in about["fields"]:
            self.choose(field["name"])
            low, high = field["low"], field["high"]
            t = (np.clip(cells[field["name"]][front], low, high) - low) / (
                high - low)
            if field["whole"]:
                t = (t * (high - low) + 0.5) / (high - low + 1)
            expected = self.expected_colours(
                field["name"], cells[field["name"]][front], t)
            pictures.append(self.picture())
            found = pictures[-1][place]
            # seen straight on, a colour gets 105 % of its light
            off = np.abs(np.minimum(255, 1.05 * expected) - found).max(axis=1)
            self.assertLess(off.min(), 12, field["name"])
            label = self.browser.text("bar")
            self.assertTrue(label.startswith(field["label"]), label)
            self.assertIn(field["unit"], label)
        self.choose("clone")
        pictures.append(self.picture())
        for i, one in enumerate(pictures):
            for other in pictures[:i]:
                self.assertGreater((one != other).any(axis=2).sum(), 500)

    def expected_colours(self, name, value, t):
        """A named number's own, or those at t and a little beside it."""
        if name in NAMED:
            return 255 * np.array([to_rgb(NAMED[name][value][1])])
        palette = palette_of(style_of(name)[1])
        near_t = np.clip(np.array([t - 0.006, t, t + 0.006]), 0, 0.999)
        return 255 * palette((256 * near_t).astype(int))[:, :3]

    def test_range(self):
        """Narrower colours change the picture and the bar, and come back."""
        self.choose("volume")
        before = self.picture()
        self.browser.set("highest", 1000, "change")
        self.assertTrue((self.picture() != before).any())
        self.assertIn("≥ 1000", self.browser.text("bar"))
        self.assertIn("clipped", self.browser.text("bar"))
        self.browser.set("highest", 1e6, "change")
        self.assertNotIn("≥", self.browser.text("bar"))
        self.click("full-range")
        np.testing.assert_array_equal(self.picture(), before)
        self.choose("pressure")
        low, high = (float(self.element(name).get_attribute("value"))
                     for name in ("lowest", "highest"))
        self.assertEqual(low, -high)
        self.choose("phase")
        for word in ("G0", "S", "G2", "M", "G1", "no cycle"):
            self.assertIn(word, self.browser.text("bar"))
        self.assertFalse(self.element("lowest").is_enabled())

    def test_turning(self):
        """By mouse and by keys; 0 brings everything back."""
        canvas = self.element("canvas")
        home = self.picture()
        chain = ActionChains(self.browser.driver, duration=20)
        chain.move_to_element(canvas).click_and_hold().move_by_offset(
            120, 30).release().perform()
        turned = self.picture()
        self.assertGreater((turned != home).any(axis=2).sum(), 5000)
        canvas.send_keys("0")
        np.testing.assert_array_equal(self.picture(), home)
        for keys in (Keys.ARROW_LEFT, Keys.ARROW_DOWN, "+", "-",
                     Keys.SHIFT + Keys.ARROW_RIGHT):
            canvas.send_keys(keys)
            self.assertGreater((self.picture() != home).any(axis=2).sum(),
                               1000, keys)
            canvas.send_keys("0")
            np.testing.assert_array_equal(self.picture(), home)
        ActionChains(self.browser.driver).scroll_from_origin(
            ScrollOrigin.from_element(canvas), 0, -200).perform()
        self.assertGreater(self.seen(self.picture()).sum(),
                           1.05 * self.seen(home).sum())
        seen = set()
        for button in self.browser.driver.find_elements(
                By.CSS_SELECTOR, "[data-look]"):
            button.click()
            seen.add(self.picture().tobytes())
        self.assertEqual(len(seen), 4)
        np.testing.assert_array_equal(self.picture(), home)

    def test_time(self):
        """Slider, brackets and play; the tissue grows."""
        areas = []
        for i in range(len(self.run_read.times)):
            self.browser.set("time", i)
            self.settle()
            areas.append(self.seen(self.picture()).sum())
            self.assertEqual(self.browser.run("return report.view.state.cells"),
                             len(self.run_read.cells(i)["id"]))
        self.assertEqual(len(set(areas)), len(areas))
        self.assertGreater(areas[-1], 1.2 * areas[0], areas)
        self.element("canvas").send_keys("[")
        self.settle()
        self.assertEqual(self.element("time").get_attribute("value"), "3")
        self.element("time").send_keys(Keys.HOME)
        self.settle()
        self.assertEqual(self.seen(self.picture()).sum(), areas[0])
        self.click("play")
        self.browser.wait("new Promise((done) => setTimeout(done, 1700))")
        self.assertEqual(self.element("play").text, "Pause")
        self.click("play")
        self.assertGreaterEqual(
            int(self.element("time").get_attribute("value")), 2)

    def test_cutting(self):
        """What is drawn lies on the right side, and all of it that can be
        seen is drawn."""
        cells = self.run_read.cells(-1)
        whole = self.picture()
        # the viewer stands at x > 0, y < 0, z > 0
        for axis, sign in (("x", ">"), ("y", "<"), ("z", ">")):
            if self.element("flip").is_selected():
                self.click("flip")
            self.browser.set("cut", axis)
            for place in (0.3, 0.6):
                self.browser.set("place", place)
                for other in (False, True):
                    if self.element("flip").is_selected() != other:
                        self.click("flip")
                    name, beyond, where = self.browser.text(
                        "place-shown").split()[:3]
                    where = float(where)
                    self.assertEqual(name, axis)
                    self.assertEqual(beyond == sign, not other)
                    on_side = (cells[axis] <= where) == (beyond == ">")
                    # the words are rounded to a whole um
                    edge = np.abs(cells[axis] - where) < 0.7
                    drawn = np.zeros(len(on_side), dtype=bool)
                    drawn[self.drawn()] = True
                    self.assertFalse((drawn & ~on_side & ~edge).any())
                    # the cube is too small to have a core
                    self.assertFalse((~drawn & on_side & ~edge).any())
                    self.assertTrue((self.picture() != whole).any())
        self.browser.set("cut", "view")
        self.assertTrue(0 < len(self.drawn()) < len(cells["id"]))
        self.browser.set("cut", "off")
        np.testing.assert_array_equal(self.picture(), whole)

    def test_cut_is_towards_the_viewer(self):
        """Wherever the view is set to; turning by hand keeps the half."""
        self.browser.set("cut", "x")
        self.assertIn("x >", self.browser.text("place-shown"))
        canvas = self.element("canvas")
        for _ in range(14):  # the viewer is now at x < 0
            canvas.send_keys(Keys.ARROW_RIGHT)
        self.assertLess(self.browser.run(
            "return report.view.camera.axes[2].x"), -0.5)
        self.assertIn("x >", self.browser.text("place-shown"))
        self.browser.set("cut", "off")
        self.browser.set("cut", "x")
        self.assertIn("x <", self.browser.text("place-shown"))
        self.browser.driver.find_element(
            By.CSS_SELECTOR, "[data-look=home]").click()
        self.assertIn("x >", self.browser.text("place-shown"))
        # what is left shows its cut: its cells there are the nearest ones
        cells = self.run_read.cells(-1)
        near = self.projected(cells)[2]
        drawn = np.zeros(len(near), dtype=bool)
        drawn[self.drawn()] = True
        self.assertGreater(near[~drawn].mean(), near[drawn].mean())

    def test_emptiness(self):
        """Is explained where the tissue would be."""
        self.assertFalse(self.element("empty").is_displayed())
        self.browser.set("cut", "x")
        self.browser.set("place", 0)
        self.picture()
        self.assertEqual(self.drawn(), [])
        self.assertIn("Everything is cut away", self.browser.text("empty"))
        self.assertTrue(self.element("empty").is_displayed())
        self.browser.set("cut", "off")
        self.click("cells-on")
        self.picture()
        self.assertIn("tick cells", self.browser.text("empty"))
        self.click("surface-on")
        self.picture()
        self.assertFalse(self.element("empty").is_displayed())

    def test_beside_each_other(self):
        """On a small laptop, whose browser needs some of its 768 rows, the
        picture and all controls are seen at once."""
        self.browser.driver.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": 1366, "height": 660, "deviceScaleFactor": 1,
             "mobile": False})
        self.addCleanup(self.browser.driver.execute_cdp_cmd,
                        "Emulation.clearDeviceMetricsOverride", {})
        self.picture()
        stage = self.element("stage").rect
        self.assertGreater(stage["width"], 700)
        self.assertGreater(stage["height"], 350)
        for name in ("stage", "bar"):
            rect = self.element(name).rect
            self.assertLessEqual(rect["y"] + rect["height"], 660, name)
        controls = self.element("controls").find_elements(
            By.CSS_SELECTOR, "button, input, select, output")
        self.assertGreater(len(controls), 20)
        for control in controls:
            rect, name = control.rect, control.get_attribute("outerHTML")
            self.assertGreater(rect["x"], stage["x"] + stage["width"], name)
            self.assertLessEqual(rect["x"] + rect["width"], 1366, name)
            self.assertLessEqual(rect["y"] + rect["height"], 660, name)
        buttons = [c.rect for c in controls if c.tag_name == "button"]
        for i, one in enumerate(buttons):
            for other in buttons[:i]:
                self.assertFalse(
                    abs(one["x"] - other["x"]) < other["width"] - 2
                    and abs(one["y"] - other["y"]) < 10
                    and one["x"] >= other["x"], (one, other))

    def saved(self, promise, name):
        """The file that a button hands over."""
        content = self.browser.wait(
            f"{promise}.then((blob) => new Promise((done) => {{"
            "const reader = new FileReader(); reader.onload = () => "
            "done(reader.result); reader.readAsDataURL(blob); }))")
        file = self.page.with_name(name)
        file.write_bytes(base64.b64decode(content.partition(",")[2]))
        self.browser.requests()  # that of the page, and of the blob itself
        self.browser.open(self.page)
        return file

    def test_saved_picture(self):
        """Has the time, the colours' meaning and the scale round the view."""
        self.choose("pressure")
        view = self.picture()
        bar = self.browser.run(
            "return document.querySelector('#scale span').clientWidth")
        whole = image_of(self.saved("report.panel.save()",
                                    "saved.png").read_bytes())
        height, width = view.shape[:2]
        self.assertEqual(whole.shape[1], width // 2 * 2)
        np.testing.assert_array_equal(whole[36:36 + height, :width // 2 * 2],
                                      view[:, :width // 2 * 2])
        self.assertGreater((whole[:36, :400] < 128).all(axis=2).sum(), 300)
        foot = whole[36 + height:]
        wide = 0.5 * whole.shape[1]  # of the ramp, which begins at 12
        for part in (0.02, 0.25, 0.5, 0.75, 0.98):
            found = foot[-32, int(12 + part * wide)]
            expected = 255 * np.array(palette_of("coolwarm")(part)[:3])
            np.testing.assert_allclose(found, expected, atol=8)
        line = (foot[-33] < 64).all(axis=1)[width // 2 + 30:]
        self.assertAlmostEqual(line.sum(), bar, delta=2)

    def test_film(self):
        """Its frames are the states: the tissue grows from the first to the
        last. Another page of the browser plays it."""
        self.assertTrue(self.element("film").is_enabled())
        film = self.saved("report.panel.saveFilm()", "film.webm")
        self.assertEqual(film.read_bytes()[:4], b"\x1aE\xdf\xa3")
        player = film.with_name("player.html")
        content = base64.b64encode(film.read_bytes()).decode()
        player.write_text("<link rel=icon href=data:,><video muted src="
                          f"'data:video/webm;base64,{content}'></video>")
        self.browser.driver.get(player.resolve().as_uri())
        areas = self.browser.driver.execute_async_script("""
            const done = arguments[0], video = document.querySelector("video");
            const areas = [], canvas = document.createElement("canvas");
            const look = () => {
              canvas.width = video.videoWidth;
              canvas.height = video.videoHeight;
              const context = canvas.getContext("2d",
                {willReadFrequently: true});
              context.drawImage(video, 0, 0);
              const h = video.videoHeight - 62 - 36;
              let bytes;
              try {
                bytes = context.getImageData(0, 36, canvas.width, h).data;
              } catch (error) { done(String(error)); return; }
              let seen = 0;
              for (let i = 0; i < bytes.length; i += 4)
                if (Math.min(bytes[i], bytes[i + 1], bytes[i + 2]) < 225)
                  ++seen;
              areas.push(seen);
              if (!video.ended) setTimeout(look, 200);
              else done(areas);
            };
            video.requestVideoFrameCallback(look);
            video.onerror = () => done("error");
            video.play();""")
        self.browser.requests()  # that of the player
        self.browser.open(self.page)
        self.assertIsInstance(areas, list, areas)
        self.assertGreater(areas[-1], 1.2 * areas[0], areas)
        # a busy machine may drop frames, but not all between
        steps = np.diff(areas)
        self.assertGreater((np.abs(steps) > 0.01 * areas[0]).sum(), 1)

    def test_surface(self):
        """The points of the slip plane are blue, the free ones grey."""
        self.click("cells-on")
        self.assertEqual(self.seen(self.picture()).sum(), 0)
        self.click("surface-on")
        picture = self.picture()
        for colour, condition in (((138, 143, 153), 0), ((59, 125, 224), 2)):
            close = (np.abs(picture - colour).max(axis=2) < 4).sum()
            expected = (self.run_read.surface(-1)["condition"]
                        == condition).sum()
            self.assertGreater(expected, 0)
            self.assertGreater(close, 5 * 0.2 * expected)
        red = (np.abs(picture - (214, 46, 46)).max(axis=2) < 20).sum()
        self.assertEqual(red, 0)
        self.assertTrue(self.element("surface-key").is_displayed())

    def test_clone(self):
        """Only the living cells of a clone are drawn, and a click says which
        cell it met."""
        run = self.run_read
        founder = int(run.lineage.clone_sizes.argmax())
        self.browser.set("clone", founder, "change")
        self.click("clone-on")
        self.settle()
        ids = run.cells(-1)["id"]
        members = set(run.clone(founder)) & set(ids.tolist())
        self.assertEqual({ids[i] for i in self.drawn()}, members)
        self.click("clone-on")
        self.settle()
        cells = run.cells(-1)
        across, down, near, _ = self.projected(cells)
        front = np.argmax(near + self.radii(cells))
        left, top = self.browser.run(
            "const c = report.view.canvas; c.scrollIntoView({block: 'center'});"
            "const b = c.getBoundingClientRect(); return [b.left, b.top]")
        actions = ActionBuilder(self.browser.driver)
        actions.pointer_action.move_to_location(
            round(left + across[front]), round(top + down[front])).click()
        actions.perform()
        self.settle()
        cell = int(cells["id"][front])
        words = self.browser.text("picked")
        self.assertTrue(words.startswith(
            f"Cell {cell}, founder {run.lineage.founder[cell]}, generation "
            f"{run.lineage.generation[cell]},"), words)

