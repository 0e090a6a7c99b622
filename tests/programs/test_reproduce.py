# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/reproduce on coarse scenes, and what it computes from runs."""
import math
from pathlib import Path

import matplotlib.image
import numpy as np
from morula import fits
from morula.draw.surface import triangles_of
from tests.common.program import ProgramTest, overrides, read_csv
from reproduction import catalogue, outline, renewal

ROOT = Path(__file__).resolve().parents[2]

CUBE = overrides({"Tissue/Cell spacing": "40", "Tissue/Boundary points": "150",
                  "Grid/Spacing": "100"})
SPHERE = overrides({"Tissue/Cell spacing": "70",
                    "Tissue/Boundary points": "300", "Grid/Spacing": "150"})


def spiral(n):
    """n points that are spread evenly over the unit sphere."""
    z = 1 - (2 * np.arange(n) + 1) / n
    angle = np.pi * (3 - math.sqrt(5)) * np.arange(n)
    r = np.sqrt(1 - z**2)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


class Surface:
    """A run whose boundary points began on a sphere and are moved."""

    def __init__(self, positions, initial):
        self.positions = positions
        self.columns = {"condition": np.where(initial[:, 2] > 0, 0, 1),
                        **dict(zip("XYZ", initial.T))}

    def read(self, kind, time):
        return self.positions, self.columns


class Computed(ProgramTest):
    """Fits, rates, outlines and triangles against closed forms."""

    def test_fits(self):
        time = np.linspace(0, 5, 101)
        found = fits.fit_exponential(time, 7500 * np.exp(0.36 * time))
        self.assertAlmostEqual(found.factor / 7500, 1, 12)
        self.assertAlmostEqual(found.rate, 0.36, 12)
        # only the range counts
        bent = np.where(time < 2 - 1e-9, 1.0, 0.095 * time - 0.029)
        line = fits.fit_line(time, bent)
        self.assertAlmostEqual(line.slope, 0.095, 12)
        self.assertAlmostEqual(line.constant, -0.029, 12)
        # alternating errors of the logarithm do not bend the fit
        noisy = np.exp(0.3 * time + 0.01 * (-1.0)**np.arange(101))
        self.assertAlmostEqual(fits.fit_exponential(time, noisy).rate, 0.3, 3)
        with self.assertRaisesRegex(fits.NothingToFit, "between 2 and 4"):
            fits.fit_line(time[:10], time[:10])

    def test_renewal(self):
        """The rates against a population counted step by step."""
        def counted(step):
            cycle = round(1 / step)
            waiting, under_way = 1.0, [0.0] * cycle
            stay = math.exp(-step)
            for _ in range(40 * cycle):
                before = waiting
                entering = (1 - stay) * waiting
                waiting = stay * waiting + 2 * under_way.pop()
                under_way.insert(0, entering)
            return math.log(waiting / before) / step

        # an onset waits for the end of its step, then takes T
        for step in (0.05, 0.1, 0.25):
            self.assertAlmostEqual(renewal.rounded_up(step), counted(step), 9)
        self.assertAlmostEqual(renewal.rounded_up(1e-5), renewal.exact(), 5)
        self.assertAlmostEqual(renewal.exact(), 0.3748, 4)
        time, cells = renewal.expected_cells(0.05, 20)
        self.assertAlmostEqual(math.log(cells[-1] / cells[-2]) / 0.05,
                               renewal.rounded_up(0.05), 6)
        # until the first daughters divide: 1 + the share that has waited
        time, cells = renewal.expected_cells(0.001, 1)
        divided = np.clip(time - 0.5, 0, None)
        self.assertLess(np.abs(cells - 2 + np.exp(-divided)).max(), 2e-3)

    def test_profile(self):
        """An ellipsoid of revolution from points without symmetry."""
        unit = spiral(2600)
        run = Surface(unit * [332, 332, 469], 250 * unit)
        r, z = outline.profile(run, 0.0)
        off = np.sqrt((r / 332)**2 + (z / 469)**2) - 1
        self.assertLess(np.abs(off).max(), 1e-3)
        self.assertTrue((np.diff(z) >= 0).all())
        self.assertGreater(len(r), 500)

    def test_distance(self):
        """5 µm outward count, a turn about the axis does not."""
        unit = spiral(2600)
        free = unit[:, 2] > 0
        turned = unit @ [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]
        run = Surface((250 + 5 * free[:, None]) * turned, 250 * unit)
        angle = np.linspace(np.pi, 0, 1001)
        sphere = 250 * np.sin(angle), 250 * np.cos(angle)
        found = outline.distance(run, 0.0, sphere)
        for value in (found.near_rms, found.near_max, found.away_rms,
                      found.away_max):
            self.assertAlmostEqual(value, 5, 2)
        # only what is near the clamp is displaced
        near = free & (unit[:, 2] < 0.4)
        run = Surface((250 + 5 * near[:, None]) * unit, 250 * unit)
        found = outline.distance(run, 0.0, sphere)
        self.assertAlmostEqual(found.near_rms, 5, 2)
        self.assertLess(found.away_max, 0.01)

    def test_polyline(self):
        """Beside, beyond the end, and on the corner of two sides."""
        corners = np.array([[0.0, 0], [4, 0], [4, 3]])
        points = np.array([[1.0, 2], [-3, -4], [4, 0], [7, 7], [3, 2]])
        np.testing.assert_allclose(outline.to_polyline(points, corners),
                                   [2, 5, 0, 5, 1])

    def test_triangles(self):
        """All points are corners; the triangles enclose the body."""
        faces = [np.insert(pair, axis, side)
                 for axis in range(3) for side in (-100.0, 100.0)
                 for pair in np.stack(np.meshgrid(
                     *2 * [np.linspace(-95, 95, 20)]), -1).reshape(-1, 2)]
        for points, volume in ((250 * spiral(2600), 4 / 3 * np.pi * 250**3),
                               (np.array(faces), 200.0**3)):
            triangles = triangles_of(points)
            self.assertEqual(len(triangles), 2 * len(points) - 4)
            a, b, c = (points[triangles[:, k]] for k in range(3))
            enclosed = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
            self.assertLess(abs(enclosed / volume - 1), 0.01)


class Reproduce(ProgramTest):
    """The command on coarse scenes."""

    def reproduce(self, *arguments, code=0):
        return self.run_words(
            [ROOT / "contrib/reproduce", "--morula",
             self.options.morula, "--output", self.work, *arguments], code)

    def assert_pictures(self, *names):
        for name in names:
            with self.subTest(name):
                picture = matplotlib.image.imread(self.work / f"{name}.png")
                self.assertGreater(min(picture.shape[:2]), 200)
                self.assertGreater(picture[:, :, :3].std(), 0.03)

    def rows(self):
        """The rows of table.md by their first two fields."""
        fields = [[field.strip() for field in line.strip("| ").split(" | ")]
                  for line in (self.work / "table.md").read_text().split("\n")
                  if line.startswith("|")]
        return {(row[0], row[1]): row[2:] for row in fields}

    def test_cubes(self):
        """Figures 1 and 3, and the numbers that a coarse cube gives, too."""
        self.reproduce("fig-1d", "fig-3", *CUBE)
        self.assert_pictures("fig-1d", "fig-3a", "fig-3b", "fig-3c", "fig-3d",
                             "fig-3e", "fig-3")
        rows = self.rows()
        doubled = rows["§2.3, Fig. 1 d", "N_p after the cycle / before"]
        self.assertEqual(doubled[:3], ["2", "2", "1.000"])
        same = rows["§2.3, Fig. 1 d", "V_p after the cycle / before"]
        self.assertAlmostEqual(float(same[1]), 1, 8)
        self.assertLess(float(rows["§3.1, Fig. 3 a",
                                   "residual stress / E"][1]), 1e-8)
        self.assertEqual(rows["§3.1", "cells of the cube"][:2],
                         ["8,000", "125"])
        run = read_csv(self.work / "fig-3b/statistics.csv")
        fitted = (run["time"] > 2 - 1e-6) & (run["time"] < 4 + 1e-6)
        rate, logarithm = np.polyfit(run["time"][fitted],
                                     np.log(run["cells"][fitted]), 1)
        self.assertAlmostEqual(float(rows["Fig. 3 c", "N_p: rate [1/day]"][1]),
                               rate, 3)
        self.assertAlmostEqual(float(rows["Fig. 3 c", "N_p: factor"][1])
                               / math.exp(logarithm), 1, 3)
        self.assertEqual(rows["§2.5", "boundary points of the sphere"][1],
                         "not run")

    def test_spheres(self):
        """Figure 4, its series and a video; then everything is there."""
        short = overrides({"Time/End time": "1", "Time/Step": "0.25",
                           "Output/Interval": "0.5"})
        panels = ("fig-4", "video-2")
        self.reproduce(*panels, *SPHERE, *short)
        self.assert_pictures(*(f"fig-4{panel}" for panel in "abcdefg"),
                             "fig-4")
        video = (self.work / "video-2.ogv").read_bytes()
        self.assertEqual(video[:4], b"OggS")
        self.assertIn(b"theora", video[:100])
        times = {path: path.stat().st_mtime_ns for path in
                 (*self.work.glob("*/statistics.csv"),
                  self.work / "video-2.ogv")}
        self.assertEqual(len(times), 7)
        again = self.reproduce(*panels, *SPHERE, *short)
        self.assertIn("video-2.ogv is up to date", again.stdout)
        for path, before in times.items():
            self.assertEqual(path.stat().st_mtime_ns, before, path)

    def test_outlines(self):
        """Figure 2: equal runs are nowhere apart."""
        self.reproduce("fig-2", "-s", "Time/End time=1", *SPHERE)
        self.assert_pictures(*(f"fig-2{panel}" for panel in "abcdefg"),
                             "fig-2")
        rows = self.rows()
        # the azimuth's part, which the mean outline does not have, stays
        self.assertLess(float(rows["b", "150"][1].split(",")[0]), 5)
        self.assertEqual(rows["a", "150"], rows["d", "150"])
        last = read_csv(self.work / "fig-2b/statistics.csv")[-1]
        self.assertIn(f"{last['zmax']:.1f}", rows["b", "150"])

    def test_goes_on(self):
        """A run that stopped early is resumed, not begun anew."""
        statistics = self.work / "fig-2b/statistics.csv"
        self.reproduce("fig-2b", "-s", "Time/End time=2", *SPHERE)
        before = statistics.read_text()
        self.reproduce("fig-2b", *SPHERE)
        after = statistics.read_text()
        self.assertEqual(len(after.splitlines()), 6)
        self.assertTrue(after.startswith(before))
        # and one that no longer fits says what to do
        changed = self.reproduce("fig-2b", *SPHERE, "-s", "Random seed=2",
                                 code=1)
        self.assertIn("Random seed", changed.stdout)
        self.assertIn("--fresh", changed.stdout)
        self.assertEqual(statistics.read_text(), after)
        self.reproduce("fig-2b", *SPHERE, "-s", "Random seed=2", "--fresh")
        self.assertNotEqual(statistics.read_text(), after)

    def test_one_failure(self):
        """What does not depend on it is drawn, and the exit code tells."""
        result = self.reproduce(
            "fig-1d", "fig-2b", *SPHERE, "-s",
            "Growth/Isotropic/Stretch=1 + 0.05*t", code=1)
        self.assertIn("FAILED: the runs fig-1d", result.stdout)
        self.assertIn("not drawn: fig-1d", result.stdout)
        self.assert_pictures("fig-2b")
        self.assertFalse((self.work / "fig-1d.png").exists())
        self.assertEqual(
            self.rows()["§2.3, Fig. 1 d", "N_p after the cycle / before"][1],
            "not run")

    def test_panels(self):
        listed = self.reproduce("--list").stdout
        for panel, (scenes, _) in catalogue.PANELS.items():
            self.assertIn(panel, listed)
            for scene in scenes:
                self.assertTrue((ROOT / f"prm/paper/{scene}.prm").is_file())
        unknown = self.reproduce("fig-5", code=2)
        self.assertIn("no panel 'fig-5'", unknown.stderr)
        self.assertIn("fig-4g", unknown.stderr)
        self.assertFalse(any(self.work.iterdir()))

