# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Questions of users, as small scenes: each has its right value, or a word."""
import numpy as np
from morula.execute import overrides
from morula.run import Run
from tests.common.program import ProgramTest, without_wall_time

OFFSETS = ("0, 0", "3, 0", "10, 7", "17, 5")
BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Time/End time": 0.2,
       "Time/Step": 0.1, "Output/Formats": "none"}
HELD = {**BOX, "Boundary conditions/Fixed where": "X < -49.9"}


class Questions(ProgramTest):
    def run_keys(self, keys, ranks=1, name="output", code=0, arguments=()):
        """The run of these keys, and what it has printed."""
        result = self.execute(self.write(f"{name}.prm", ""), *overrides(keys),
                              *arguments, ranks=ranks, code=code,
                              output=self.work / name)
        return Run(self.work / name), result.text

    @staticmethod
    def time_of_gap(said):
        """Since when the surface faces itself, day."""
        before = said.split(" day on the surface faces itself")[0]
        return float(before.rsplit("from t = ", 1)[1])

    def test_bodies_near_each_other(self):
        """Cells of 5 um, a gap of 30 um: apart, or a word."""
        rows = [f"{x},{y},25" for y in np.arange(-22.5, 25, 5)
                for x in (*np.arange(-97.5, -20, 5), *np.arange(12.5, 90, 5))]
        file = self.write("bodies.csv", "\n".join(["x,y,volume", *rows]))
        keys = {"Dimension": 2, "Time/End time": 0.3, "Time/Step": 0.1,
                "Tissue/Shape": "points", "Tissue/Points file": file,
                "Grid/Spacing": 20, "Output/Formats": "csv",
                "Boundary conditions/Fixed where": "X < -97",
                "Boundary conditions/Traction where": "X > 87",
                "Boundary conditions/Traction": "0.02*t; 0",
                "Output/Interval": 0.3}
        apart = 0
        for number, offset in enumerate(OFFSETS):
            run, said = self.run_keys({**keys, "Grid/Offset": offset},
                                      ranks=1 + number % 2, name=f"o{number}")
            edge = run.surface(1)["x"].max()
            # the right body flies, the left one does not know of it
            left = run.surface(1).query("X < 0")
            moved = abs(left["x"] - left["X"]).max()
            if "stick together from the start" in said:
                continue
            apart += 1
            self.assertLess(moved, 1e-6)
            self.assertAlmostEqual(edge, 90.249, delta=0.01)
        self.assertGreaterEqual(apart, 1)

    def test_hole_that_closes(self):
        keys = {"Dimension": 2, "Time/End time": 0.9, "Time/Step": 0.05,
                "Tissue/Radius": 200, "Tissue/Inner radius": 80,
                "Tissue/Cell spacing": 4, "Tissue/Surface cells": "trimmed",
                "Grid/Spacing": 20, "Material/Poisson's ratio": 0.3,
                "Boundary conditions/Fixed where": "X^2 + Y^2 > 190^2",
                "Boundary conditions/Surface tension where":
                    "X^2 + Y^2 < 90^2",
                "Boundary conditions/Surface tension": "100*t",
                "Output/Formats": "csv", "Output/Interval": 0.3}
        for number, offset in enumerate(OFFSETS[::2]):
            run, said = self.run_keys({**keys, "Grid/Offset": offset},
                                      ranks=1 + number, name=f"hole-{number}")
            self.assertEqual(said.count("the splines reach across"), 1)
            time = self.time_of_gap(said)
            self.assertGreater(time, 0.5)
            self.assertLess(time, 0.8)
            rim = run.surface(2).query("X**2 + Y**2 < 90**2")
            self.assertAlmostEqual(np.hypot(rim["x"], rim["y"]).mean(), 24.19,
                                   delta=1.5)

    def test_arms_that_join(self):
        """A ring that is open at the right closes."""
        keys = {"Dimension": 2, "Time/End time": 1, "Time/Step": 0.05,
                "Tissue/Radius": 120, "Tissue/Inner radius": 80,
                "Tissue/Cell spacing": 8, "Grid/Spacing": 16,
                "Death/When": "X > 0 && abs(Y) < 28", "Death/Shrinking time": 0,
                "Growth/Law": "isotropic",
                "Growth/Isotropic/Stretch": "1 + 0.6*t*(X > 20)",
                "Output/Formats": "none"}
        times = []
        for ranks in (1, 2):
            _, said = self.run_keys(keys, ranks=ranks, name=f"ring-{ranks}")
            self.assertEqual(said.count("the surface faces itself"), 1, said)
            times.append(self.time_of_gap(said))
        self.assertGreater(times[0], 0)
        self.assertAlmostEqual(times[0], times[1], delta=0.051)

    def test_springs_to_the_ground(self):
        """u'' = k u of a bar, with this law's strain: 5.419 um at the tip, from
        the first step on; linear 5.391 um."""
        keys = {"Dimension": 2, "Tissue/Shape": "box",
                "Tissue/Size": "400, 40", "Tissue/Cell spacing": 5,
                "Grid/Spacing": 20, "Material/Poisson's ratio": 0,
                "Boundary conditions/Fixed where": "X < -199.9",
                "Boundary conditions/Traction where": "X > 199.9",
                "Boundary conditions/Traction": "0.02; 0",
                "Body force/Force density": "-1e-5*(x - X); 0",
                "Output/Formats": "csv", "Output/Interval": 0.1,
                "Time/End time": 0.3, "Time/Step": 0.1}
        for number, offset in enumerate(OFFSETS):
            run, _ = self.run_keys({**keys, "Grid/Offset": offset},
                                   ranks=1 + number % 2, name=f"k{number}")
            for state in (1, 2, 3):
                tip = run.surface(state).query("X > 199.9")
                self.assertAlmostEqual((tip["x"] - tip["X"]).mean() / 5.419, 1,
                                       delta=0.01)
        stiff = {"Body force/Force density": "-3e-5*(x - X); 0"}
        run, _ = self.run_keys({**keys, **stiff}, name="stiff")
        tip = run.surface(1).query("X > 199.9")
        root = np.sqrt(3e-5)
        linear = 0.02 / root * np.tanh(400 * root)
        self.assertAlmostEqual((tip["x"] - tip["X"]).mean() / linear, 1,
                               delta=0.01)
        state = {"Body force/Force density": "-1e-5*volume; 0"}
        _, said = self.run_keys({**keys, **state}, name="state")
        self.assertIn("a force takes the state of its cell", said)

    def test_load_that_jumps(self):
        run, _ = self.run_keys({
            **HELD, "Tissue/Cell spacing": 5, "Grid/Spacing": 20,
            "Time/End time": 0.6,
            "Boundary conditions/Fixed where": "Y < -49.9",
            "Boundary conditions/Pressure where": "Y > 49.9",
            "Boundary conditions/Pressure": "1.5*(t > 0.45)"})
        force = run.forces.set_index(["time", "name"])["force_y"]
        self.assertAlmostEqual(force[0.6, "fixed"], -force[0.6, "pressure"],
                               delta=1e-4)

    def test_time_is_the_decimal_that_is_written(self):
        """7 * 0.1 is more than 0.7, and 3 * 0.05 is more than 0.15."""
        for step, first in ((0.1, 0.7), (0.05, 0.15), (0.3, 0.9)):
            run, _ = self.run_keys({
                **HELD, "Time/Step": step, "Time/End time": first + step,
                "Boundary conditions/Traction where": "X > 49.9",
                "Boundary conditions/Traction": f"0.01*(t <= {first}); 0",
                "Output/Interval": step}, name=f"step-{step}")
            pull = run.forces.query("name == 'traction'")["force_x"].to_numpy()
            np.testing.assert_allclose(pull[-2:], [1, 0], atol=1e-12)

    def test_amount_of_a_field_at_removal(self):
        for ranks in (1, 2):
            run, _ = self.run_keys({
                **BOX, "Tissue/Size": "160, 160", "Tissue/Cell spacing": 8,
                "Grid/Spacing": 32, "Time/End time": 0.6,
                "Material/Energy per": "grown volume",
                "Material/Volumetric strain": "pooled",
                "Material/Relaxation time": 0.05,
                "Death/When": "noise < 0.5", "Death/Shrinking time": 0.3,
                "Death/Final volume": 0.05, "Fields/Names": "u",
                "Fields/u/Time": "transient", "Fields/u/Diffusion": 10,
                "Fields/u/Initial": 1}, ranks=ranks, name=f"ranks-{ranks}")
            table = run.statistics
            amount = table["u_mean"] * table["total_volume"]
            self.assertGreater(table["removed"].sum(), 100)
            np.testing.assert_allclose(amount / amount[0], 1, rtol=1e-8)

    def test_axes_along_a_gradient_at_the_start(self):
        keys = {**BOX, "Tissue/Cell spacing": 5, "Grid/Spacing": 25,
                "Time/End time": 1.2, "Time/Step": 0.3,
                "Proliferation/Law": "cell cycle",
                "Proliferation/Cell cycle/Start": "together",
                "Proliferation/Cell cycle/G0 exit rate": 0,
                "Proliferation/Cell cycle/Duration": 1,
                "Proliferation/Cell cycle/Division axis": "gradient of u",
                "Fields/Names": "u", "Fields/u/Diffusion": 1e6}
        steady = {"Fields/u/Fixed where": 1, "Fields/u/Value": "300 + X + 2*Y"}
        moving = {"Fields/u/Time": "transient",
                  "Fields/u/Initial": "300 + X + 2*Y"}
        for name, more in (("steady", steady), ("moving", moving)):
            run, _ = self.run_keys({**keys, **more}, name=name)
            born = run.lineage.table.query("parent >= 0")
            pairs = born.groupby("parent")[["x", "y"]]
            axes = (pairs.first() - pairs.last()).to_numpy()
            self.assertEqual(len(axes), 400)
            along = abs(axes @ [1, 2]) / np.sqrt(5)
            cosine = along / np.linalg.norm(axes, axis=1)
            self.assertGreater(cosine.min(), 0.999, name)

    def test_fields_in_any_order(self):
        keys = {**BOX, "Tissue/Size": "200, 40", "Tissue/Cell spacing": 5,
                "Grid/Spacing": 20, "Time/End time": 1}
        for field in "ab":
            keys |= {f"Fields/{field}/Time": "transient",
                     f"Fields/{field}/Diffusion": 100}
        keys |= {"Fields/a/Consumption": 2, "Fields/a/Initial": 5,
                 "Fields/b/Production": "2*a"}
        for number, names in enumerate(("a, b", "b, a")):
            run, _ = self.run_keys({"Fields/Names": names, **keys},
                                   name=f"order-{number}")
            last = run.statistics.iloc[-1]
            self.assertAlmostEqual(last["a_mean"] + last["b_mean"], 5, places=8)

    def test_a_wait_ends_when_its_rate_says(self):
        for step in (0.25, 0.125):
            run, _ = self.run_keys({
                **BOX, "Tissue/Cell spacing": 5, "Grid/Spacing": 25,
                "Time/End time": 1.5, "Time/Step": step,
                "Proliferation/Law": "cell cycle",
                "Proliferation/Cell cycle/Duration": 1,
                "Proliferation/Cell cycle/G0 exit rate": "200*(t > 0.5)"},
                name=f"wait-{step}")
            born = run.lineage.birth_time
            self.assertAlmostEqual(born[born > 0].min(), 1, delta=1e-3)

    def test_drop_keeps_its_surface(self):
        for number, offset in enumerate(OFFSETS[::2]):
            run, said = self.run_keys({
                "Dimension": 2, "Time/End time": 5, "Time/Step": 0.05,
                "Tissue/Shape": "ellipsoid", "Tissue/Size": "240, 120",
                "Tissue/Cell spacing": 5, "Tissue/Refine surface": "true",
                "Grid/Spacing": 20, "Grid/Offset": offset,
                "Material/Relaxation time": 0.1,
                "Material/Volumetric strain": "projected",
                "Boundary conditions/Surface tension": 6,
                "Output/Formats": "none"}, ranks=1 + number,
                name=f"drop-{number}")
            table = run.statistics
            share = table["enclosed_volume"] / table["total_volume"]
            np.testing.assert_allclose(share / share[0], 1, atol=0.02)
            self.assertNotIn("the surface encloses", said)

    def test_snapshots_by_the_clock(self):
        keys = {**HELD, "Time/End time": 1,
                "Boundary conditions/Traction where": "X > 49.9",
                "Boundary conditions/Traction": "0.05*t; 0"}
        often, _ = self.run_keys({**keys, "Output/Snapshot minutes": 1e-9},
                                 name="often")
        never, _ = self.run_keys({**keys, "Output/Snapshot minutes": 0},
                                 name="never")
        self.assertEqual(without_wall_time(often.directory),
                         without_wall_time(never.directory))
        self.assertEqual(never.timings.loc["snapshot", "calls"], 1)
        self.assertGreater(often.timings.loc["snapshot", "calls"], 1)

    def test_what_is_applied_is_said(self):
        keys = {**HELD, "Boundary conditions/Traction where": "X > 49.9",
                "Boundary conditions/Traction": "0.05*t; 0.01"}
        run, said = self.run_keys(keys, name="said")
        lines = ("Applied: fixed at 10 boundary points, 100 um, from (-50 -45) "
                 "to (-50 45) um",
                 "Applied: traction at 10 boundary points, 100 um, from (50 "
                 "-45) to (50 45) um; force (1 1) kPa um in sum, 1.414 in "
                 "magnitudes, at t = 0.2 day on the surface of t = 0",
                 "Material: neo-Hookean, E = 1.0 kPa, nu = 0.4 (plane strain)")
        log = (run.directory / "log.txt").read_text()
        for line in lines:
            self.assertIn(line, said)
            self.assertIn(line, log)
        explained = self.run_words(self.command(
            self.work / "said.prm", "--explain", *overrides(keys))).text
        for line in lines[:2]:
            self.assertIn(line.split(" at ", 1)[1], explained)
        self.assertIn(lines[2].removeprefix("Material: "), explained)

    def test_words_on_what_is_applied(self):
        for name, keys, word in (
                ("few", {"Boundary conditions/Fixed where": "X + Y < -90"},
                 "it acts on 2 boundary points"),
                ("flies", {"Boundary conditions/Fixed where": "",
                           "Boundary conditions/Traction where": "X > 49.9",
                           "Boundary conditions/Traction": "0.01; 0"},
                 "nothing holds the tissue"),
                ("pascal", {"Material/Young's modulus": 1000},
                 "Is it in Pa or MPa?"),
                ("megapascal", {"Material/Young's modulus": 0.001},
                 "Is it in Pa or MPa?"),
                ("hours", {"Material/Relaxation time": 6}, "Is it in hours?"),
                ("cycle", {"Proliferation/Law": "cell cycle",
                           "Proliferation/Cell cycle/Duration": 24},
                 "Is it in hours?")):
            _, said = self.run_keys({**HELD, **keys}, name=name)
            self.assertIn(word, said, name)
        _, said = self.run_keys(HELD, name="plain")
        self.assertNotIn("Warning", said)

