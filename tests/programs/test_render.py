# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/render: cells are where they are, colours mean what they say, all
states and films, and what it refuses; and what tools say when a library of
Python is missing."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from matplotlib.colors import to_rgb
from morula.draw import discs, spheres
from morula.draw.colours import OF_TYPES, colours_of, limits_of
from morula.draw.outline import inside_of_cut
from morula.draw.view import cut_plane, view_of
from morula.render.tool import progress
from PIL import Image
from tests.common.program import SCENES, ProgramTest, overrides

ROOT = Path(__file__).resolve().parents[2]

CUBE = SCENES.parent / "programs/small-cube.prm"
HEADER = "time,id,x,y,z,volume,phase,pressure"


class Spheres(ProgramTest):
    """The renderer itself, looking along the y axis from below."""

    RED, BLUE = (200, 0, 0), (0, 0, 200)

    def picture(self, positions, radii, colours, gaps=0.0):
        positions = np.array(positions, dtype=float)
        view = view_of(np.array([[-30., -30, -30], [30, 30, 30]]),
                       azimuth=-90, elevation=0)
        picture = spheres.render(positions, np.array(radii), np.uint8(colours),
                                 view, (318, 318), gaps)
        self.assertEqual(picture.shape, (318, 318, 3))
        return picture, 318 / (2 * view.half_width)

    def test_places(self):
        """Two balls, one of them partly behind the other."""
        picture, scale = self.picture([(0, -20, 0), (12, 10, 5)], [10, 8],
                                      [self.RED, self.BLUE])
        rows, columns = np.indices(picture.shape[:2]) + 0.5
        across, up = (columns - 159) / scale, (159 - rows) / scale
        red = np.hypot(across, up)
        blue = np.hypot(across - 12, up - 5)
        edge = 1 / scale  # where a pixel is both
        is_red = picture[:, :, 0] > picture[:, :, 2]
        is_blue = picture[:, :, 2] > picture[:, :, 0]
        self.assertTrue(is_red[red < 10 - edge].all())
        self.assertTrue(is_blue[(blue < 8 - edge) & (red > 10 + edge)].all())
        outside = (red > 10 + edge) & (blue > 8 + edge)
        self.assertTrue((picture[outside] == 1).all())
        # the middle is seen straight on: ambient light, and three lights
        light = 0.3
        for direction, strength in spheres.LIGHTS:
            direction = np.array(direction) / np.linalg.norm(direction)
            light += 0.85 * strength * max(0, direction[2])
        self.assertAlmostEqual(picture[159, 159, 0],
                               min(1, light * 200 / 255), delta=0.03)

    def test_depth_decides(self):
        """Not the order in which they come."""
        places, colours = [(0, -20, 0), (3, 10, 0)], [self.RED, self.BLUE]
        one, _ = self.picture(places, [10, 10], colours)
        other, _ = self.picture(places[::-1], [10, 10], colours[::-1])
        np.testing.assert_array_equal(one, other)

    def test_gaps_are_dark(self):
        """A ball in a hollow among others loses light, one alone does not."""
        alone = [(0, 0, 0)]
        ring = [(14 * np.cos(a), -12, 14 * np.sin(a))
                for a in np.arange(0, 6.28, 0.52)]
        place = (159, 159)
        lone = [self.picture(alone, [8], [self.RED], gaps)[0][place]
                for gaps in (0.0, 15.0)]
        np.testing.assert_allclose(*lone, atol=0.02)
        deep, _ = self.picture(alone + ring, [8] * 14, [self.RED] * 14, 15.0)
        self.assertLess(deep[place][0], 0.85 * lone[0][0])


class Discs(ProgramTest):
    def test_colours_and_places(self):
        """Cells of a 2-D run: the colour itself inside, a darker rim, white
        beside; where two overlap, the nearer middle's."""
        view = view_of(np.array([[-30., -30, 0], [30, 30, 0]]), flat=True)
        picture = discs.render(np.array([[0., 0, 0], [14, 0, 0]]),
                               np.array([10., 10]), np.uint8([[200, 0, 0],
                                                             [0, 0, 200]]),
                               view, (318, 318))
        scale = 318 / (2 * view.half_width)
        rows, columns = np.indices(picture.shape[:2]) + 0.5
        x, y = (columns - 159) / scale, (159 - rows) / scale
        one, other = np.hypot(x, y), np.hypot(x - 14, y)
        edge, rim = 1 / scale, 0.8 + 1 / scale
        red, blue = np.array([200, 0, 0]) / 255, np.array([0, 0, 200]) / 255
        inner = (one < 10 - rim) & (one < other - edge)
        np.testing.assert_allclose(picture[inner], np.tile(
            red, (inner.sum(), 1)), atol=1e-6)
        inner = (other < 10 - rim) & (other < one - edge)
        np.testing.assert_allclose(picture[inner], np.tile(
            blue, (inner.sum(), 1)), atol=1e-6)
        rims = (np.abs(one - 9.7) < 0.1) & (other > 11)
        self.assertTrue((picture[rims][:, 0] < 0.75 * red[0]).all())
        self.assertTrue((picture[(one > 10 + edge) & (other > 10 + edge)]
                         == 1).all())


class Outline(ProgramTest):
    def ball(self, radius=50.0, inner=0.0):
        """Cells of a ball, perhaps a hollow one, and its boundary points."""
        axis = np.arange(-radius, radius + 1, 5.0)
        cells = np.stack(np.meshgrid(axis, axis, axis), -1).reshape(-1, 3)
        far = np.linalg.norm(cells, axis=1)
        cells = cells[(far < radius) & (far > inner)]
        k = np.arange(4000) + 0.5
        height, turn = 1 - k / 2000, np.pi * (1 + 5**0.5) * k
        flat = np.sqrt(1 - height**2)
        unit = np.stack([flat * np.cos(turn), flat * np.sin(turn), height], 1)
        surface = radius * unit, unit
        if inner:
            surface = (np.concatenate([surface[0], inner * unit]),
                       np.concatenate([unit, -unit]))
        return cells, surface

    def test_is_that_of_the_plane(self):
        """Of a ball cut off its middle: the circle in the plane, as it is seen
        under an angle; of a hollow one, with the circle within."""
        for inner, height in ((0.0, 0.0), (0.0, 30.0), (25.0, 0.0)):
            cells, surface = self.ball(inner=inner)
            view = view_of(surface[0], 5.0, -60, 14)
            _, normal = cut_plane(surface[0], -60)
            pixels = view.pixels(300)
            mask = inside_of_cut(cells, 5.0, surface, (height * normal, normal),
                                 view, pixels)
            self.assertEqual(mask.shape, pixels[::-1])
            unit = view.direction / np.linalg.norm(view.direction)
            area = (mask > 0.5).sum() * (2 * view.half_width / 300)**2
            circle = np.pi * (50**2 - height**2 - inner**2) * abs(unit @ normal)
            self.assertLess(abs(area / circle - 1), 0.02, (inner, height))

    def test_from_its_edge_there_is_none(self):
        cells, surface = self.ball()
        view = view_of(surface[0], 5.0, -60, 89.9)
        self.assertIsNone(inside_of_cut(cells, 5.0, surface,
                                        cut_plane(surface[0], -60), view,
                                        (300, 300)))


class Meaning(ProgramTest):
    def test_pressure_and_stress(self):
        """As far on both sides of zero, which is the middle colour."""
        values = np.array([-1.0, 0.5, 3.0])
        for field in ("pressure", "sigma_xy", "principal_stress_3"):
            low, high = limits_of(field, values)
            self.assertEqual(low, -high)
            zero = colours_of(field, values).of([0.0])[0].astype(int)
            self.assertLess(np.ptp(zero), 25, "not grey")
        self.assertGreater(limits_of("energy_density", values)[0], -1)

    def test_phases(self):
        """Have names, and the same colour whichever of them there are."""
        some, all_of_them = (colours_of("phase", np.array(v)) for v in
                             ([0, 4], [0, 1, 2, 3, 4, 9]))
        self.assertEqual(list(some.names.values()),
                         ["G0", "S", "G2", "M", "G1", "no cycle"])
        np.testing.assert_array_equal(some.of([0, 4, 9]),
                                      all_of_them.of([0, 4, 9]))
        colours = {tuple(c) for c in some.of([0, 1, 2, 3, 4, 9])}
        self.assertEqual(len(colours), 6)

    def test_held(self):
        colours = colours_of("held_at_checkpoint", np.array([0, 1]))
        self.assertEqual(list(colours.names.values()), ["not held", "held"])

    def test_types(self):
        """Have the names of the run; one that it does not name, its number.
        The colours of sixteen differ, and do not depend on which there are."""
        names = [f"type{i}" for i in range(16)]
        some = colours_of("type", np.array([0, 1, 0]), types=names[:2])
        many = colours_of("type", np.array([5, 0]), types=names)
        self.assertEqual(list(some.names.values()), names[:2])
        self.assertEqual(list(many.names.values()), names)
        np.testing.assert_array_equal(some.of([0, 1]), many.of([0, 1]))
        self.assertEqual(len({tuple(c) for c in many.of(range(16))}), 16)
        more = colours_of("type", np.array([0, 2]), types=names[:1])
        self.assertEqual(list(more.names.values()), ["type0", "1", "2"])
        long = colours_of("type", np.array([0]), types=["a" * 30, "b"])
        self.assertGreater(long.longest_name, 2 * some.longest_name)

    def test_clipping(self):
        """Ends of the bar that stand for more than themselves are arrows."""
        values = np.linspace(0, 10, 1001)
        for limits, extend in ((None, "both"), ((0, 10), "neither"),
                               ((0, 5), "max"), ((5, 10), "min")):
            self.assertEqual(colours_of("volume", values, limits).extend,
                             extend)


class Render(ProgramTest):
    def setUp(self):
        super().setUp()
        self.output = self.work / "run"
        self.output.mkdir()

    def lattice(self, n, time=0.0, number=0, spacing=10.0):
        """A file of the cells of a cube."""
        axis = np.arange(n) * spacing
        x, y, z = (a.ravel() for a in np.meshgrid(axis, axis, axis))
        ids = np.arange(len(x))
        rows = np.stack([0 * x + time, ids, x, y, z, 0 * x + 1000,
                         ids % 5, np.sin(ids)], axis=1)
        np.savetxt(self.output / f"cells-{number:04}.csv", rows, "%.10g", ",",
                   header=HEADER, comments="")

    def render(self, *words, code=0):
        done = self.run_words([ROOT / "contrib/render", self.output, *words],
                              code)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def test_states_and_films(self):
        """All with one view and one meaning of the colours."""
        for i in range(3):
            self.lattice(4, 0.5 * i, i, 10 + i)
        small = "--width", "120"
        self.render("--all", "--field", "pressure", *small)
        pictures = [np.asarray(Image.open(self.output / f"pressure-000{i}.png"))
                    for i in range(3)]
        white = [(p[60:-100, :120] > 250).all(axis=2).mean() for p in pictures]
        self.assertEqual(len({p.shape for p in pictures}), 1)
        self.assertTrue(white[0] > white[1] > white[2], white)
        film = self.work / "film.gif"
        said = self.render("--movie", "--panels", "2", "--output", film, *small)
        self.assertEqual([line.partition(",")[0] for line
                          in said.stderr.splitlines()],
                         [f"render: picture {i} of 3" for i in (1, 2, 3)])
        self.assertEqual(progress(2, 8, 10.0),
                         "render: picture 2 of 8, 30 s left")
        with Image.open(film) as frames:
            self.assertEqual(frames.n_frames, 3)
            frames.seek(2)
            self.assertEqual(frames.info["duration"], 1000)
        film = self.work / "film.ogv"
        self.render("--movie", "--output", film, *small)
        self.assertEqual(film.read_bytes()[:4], b"OggS")
        self.assertIn(b"theora", film.read_bytes()[:200])
        self.assertEqual([f.name for f in self.work.iterdir()
                          if "part" in f.name], [])
        self.render("--movie", *small)
        kind = "mp4" if shutil.which("ffmpeg") else "gif"
        self.assertTrue((self.output / f"volume.{kind}").is_file())

    def test_types(self):
        """Are called as in the run's parameters.prm, with as much room as the
        longest name needs; without that file, by their numbers."""
        self.lattice(3)
        file = self.output / "cells-0000.csv"
        file.write_text(file.read_text().replace("phase", "type", 1))
        small = "--field", "type", "--width", "200", "--output"
        self.render(*small, self.work / "numbers.png")
        self.assertEqual(sorted(f.suffix for f in self.output.iterdir()),
                         [".csv"])
        (self.output / "parameters.prm").write_text(
            "subsection Cell types\n  set Names = a, b, c, d, "
            + "hypertrophic" * 3 + "\nend\n")
        self.render(*small, self.work / "names.png")
        # the field that is drawn unless another one is asked for
        self.render("--width", "200")
        self.assertEqual((self.output / "type.png").read_bytes(),
                         (self.work / "names.png").read_bytes())
        numbers, names = (np.asarray(Image.open(self.work / f"{name}.png"))
                          for name in ("numbers", "names"))
        self.assertGreater(names.shape[1], numbers.shape[1] + 200)
        # all that is written lies within the picture
        self.assertTrue((names[:, -4:] == 255).all())
        for colour in (to_rgb(c) for c in OF_TYPES[:5]):
            there = np.abs(names - 255 * np.array(colour)).max(axis=2) < 3
            self.assertGreater(there[:, 200:].sum(), 500)

    def test_refusals(self):
        self.lattice(3, 0.0, 0)
        self.lattice(3, 2.0, 1)
        for words, texts in {
                ("--time", "2.5"): ("--time", "2.5", "from 0 to 2"),
                ("--time", "-1"): ("--time", "from 0 to 2"),
                ("--time", "nan"): ("--time", "from 0 to 2"),
                ("--range", "3,1"): ("--range", "LOW,HIGH"),
                ("--range", "a"): ("--range", "LOW,HIGH"),
                ("--width", "0"): ("--width", "20 to 20000"),
                ("--field", "speed"): ("--field", "speed", "pressure"),
                ("--section",): ("--section", "--shapes"),
                ("--movie", "--fps", "0"): ("--fps", "above 0"),
                ("--movie", "--output", "a.avi"): ("a.avi", ".ogv", ".mp4"),
                ("--output", "/nowhere/a.png"): ("--output", "exists"),
                }.items():
            said = self.render(*words, code=1).stderr
            for text in texts:
                self.assertIn(text, said)
        self.assertEqual(sorted(f.name for f in self.output.iterdir()),
                         ["cells-0000.csv", "cells-0001.csv"])
        self.render("--time", "1.9", "--width", "100")

    def test_film_without_ffmpeg(self):
        """The sentence names the package, and what goes without it."""
        self.lattice(3)
        folder = self.work / "bin"  # what the tool's own script needs
        folder.mkdir()
        for word in ("dirname", "readlink"):
            (folder / word).symlink_to(shutil.which(word))
        done = subprocess.run(
            [ROOT / "contrib/render", self.output, "--movie", "--output",
             "a.mp4"], text=True, check=False,
            env={**os.environ, "PATH": str(folder)}, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1)
        for word in ("ffmpeg", "package", ".gif"):
            self.assertIn(word, done.stderr)

    def test_thousands_of_cells(self):
        """9,261 cells in two panels fill them both."""
        self.lattice(21)
        self.render("--panels", "2", "--field", "pressure")
        picture = np.asarray(Image.open(self.output / "pressure.png"))
        self.assertGreater(picture.shape[1], 2000)
        drawn = (picture < 200).any(axis=2)
        for panel in np.array_split(drawn, 2, axis=1):
            self.assertGreater(panel.mean(), 0.2)


class VirtualScreen(ProgramTest):
    # Draws nothing, but wants a screen of its own while it has one.
    NESTED = """import os, sys
from morula.draw.screen import run_on_virtual_screen
print(os.environ["DISPLAY"], flush=True)
depth = int(sys.argv[2])
sys.exit(3 if depth == 0 else run_on_virtual_screen(
    [sys.executable, "-c", sys.argv[1], sys.argv[1], str(depth - 1)]))
"""

    def test_displays(self):
        """None of 0 to 9, where Open MPI looks for graphics cards, and none
        that another process has."""
        done = subprocess.run(
            [sys.executable, "-c", self.NESTED, self.NESTED, "2"],
            capture_output=True, text=True, check=False,
            env={**os.environ, "DISPLAY": ":own"})
        self.assertEqual(done.returncode, 3, done.stderr)
        own, *displays = done.stdout.split()
        self.assertEqual(own, ":own")
        numbers = {int(display[1:]) for display in displays}
        self.assertEqual(len(numbers), 2)
        self.assertGreaterEqual(min(numbers), 10)


class MissingLibraries(ProgramTest):
    """One sentence with the package's name, exit code 1."""

    def without(self, module, tool, *words):
        stub = self.work / "stubs" / module / "__init__.py"
        stub.parent.mkdir(parents=True, exist_ok=True)
        stub.write_text(f"raise ModuleNotFoundError(\"No module named "
                        f"'{module}'\", name='{module}')\n")
        done = subprocess.run(
            [ROOT / "contrib" / tool, *map(str, words)],
            text=True, check=False, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": str(stub.parents[1])})
        shutil.rmtree(stub.parents[1])
        return done

    def assert_sentence(self, done, tool, package):
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertTrue(done.stderr.startswith(f"{tool}: "), done.stderr)
        self.assertIn(f"Debian's package {package}", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_vtk(self):
        """Needed for VTU files alone, when they are read."""
        output = self.work / "run"
        self.execute(CUBE, *overrides({"Time/End time": "0.25",
                                       "Output/Formats": "vtu"}),
                     output=output)
        for tool in ("report", "render", "cell-shapes"):
            self.assert_sentence(self.without("vtkmodules", tool, output),
                                 tool, "python3-vtk9")
        self.execute(CUBE, *overrides({"Time/End time": "0.25"}),
                     output=output)
        for tool in ("report", "render"):
            done = self.without("vtkmodules", tool, output)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_others(self):
        for tool in ("accuracy", "render", "report", "sweep",
                     *(f"upkeep/{name}" for name in (
                         "accuracy-ladders", "half-fixed-sphere",
                         "step-pages"))):
            self.assert_sentence(self.without("numpy", tool, "--help"),
                                 Path(tool).name, "python3-numpy")
        for tool in ("render", "report", "accuracy"):
            self.assert_sentence(
                self.without("matplotlib", tool, "--help"), tool,
                "python3-matplotlib")

