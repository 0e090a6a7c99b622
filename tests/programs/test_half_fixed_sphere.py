# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The finite-element reference for the half-fixed sphere: its derivatives, a
solution known exactly, and a short ladder of meshes against the committed
values (doc/half-fixed-sphere.md).
"""
import math
import re
from pathlib import Path

import numpy
from tests.common.program import ProgramTest, overrides, read_csv

DATA = Path(__file__).resolve().parents[2] / "doc/data"
RADIUS = 250.0
QUANTITIES = ("apex", "total_volume", "mean_energy_density")


class HalfFixedSphere(ProgramTest):
    def grow(self, *arguments, code=0, **keys):
        """Runs the program; returns the process."""
        keys = {key.replace("_", " "): value for key, value in keys.items()}
        program = Path(self.options.morula).parent / "half-fixed-sphere"
        return self.run_words(
            [program, *overrides({"Output": self.work / "run", **keys}),
             *arguments], code)

    def summary(self):
        return read_csv(self.work / "run.csv")

    def test_derivatives(self):
        """The residual is the energy's derivative, the tangent the
        residual's. Central differences of the energy lose digits to rounding,
        hence the wider limit."""
        for edge_levels in (0, 2):
            printed = self.grow("--check-tangent", Growth_stretches="1.2",
                                Uniform_levels=0,
                                Edge_levels=edge_levels).stdout
            residual, tangent = (
                float(re.search(f"{name}: (.*)", printed)[1])
                for name in ("residual against energy",
                             "tangent against residual"))
            self.assertLess(residual, 1e-4)
            self.assertLess(tangent, 1e-7)

    def test_free_growth(self):
        """Where nothing is held the sphere grows by theta without stress, on
        any mesh; the lowest point stays."""
        self.grow(Hold_lower_surface="false", Edge_levels=2, Degree=3,
                  Clamp_edge=-30)
        for row in self.summary():
            theta = row["theta"]
            volume = 4 / 3 * math.pi * (RADIUS * theta)**3
            self.assertAlmostEqual(row["apex"], RADIUS * (2 * theta - 1), 6)
            self.assertAlmostEqual(row["max_radius"], RADIUS * theta, 3)
            self.assertAlmostEqual(row["total_volume"] / volume, 1, 5)
            self.assertLess(abs(row["mean_energy_density"]), 1e-12)
            self.assertAlmostEqual(row["min_elastic_volume_ratio"], 1, 7)
            self.assertAlmostEqual(row["max_elastic_volume_ratio"], 1, 7)

    def test_quadratic_convergence(self):
        printed = self.grow(Edge_levels=0, Growth_stretches="1.1, 1.2",
                            Newton_tolerance=1e-6).stdout
        for increment in printed.split("theta = ")[1:]:
            residuals = [float(text) for text in
                         re.findall(r"residual (\S+)", increment)]
            a, b, c = numpy.log(residuals[-3:])
            self.assertGreater((c - b) / (b - a), 1.8, increment)

    def test_reference(self):
        """Each mesh is above the committed energy, which is a minimum, and
        comes nearer to all values; what three meshes extrapolate to is as far
        from the committed value as the errors of both allow."""
        reference = read_csv(DATA / "half-fixed-sphere.csv")
        ladder = []
        for edge_levels in (0, 2, 4):
            self.grow(Edge_levels=edge_levels, Uniform_levels=1)
            ladder.append(self.summary())
        for name in QUANTITIES:
            value, error = reference[name], reference[f"{name}_error"]
            off = [abs(run[name] - value) for run in ladder]
            self.assertTrue((off[1] < off[0]).all(), name)
            self.assertTrue((off[2] < off[1] + error).all(), name)
            limit = ladder[2][name] + (ladder[2][name] - ladder[1][name]) / 3
            stated = abs(limit - ladder[2][name]) + error
            self.assertTrue((abs(limit - value) < stated).all(),
                            f"{name}: {limit}, {value} to {stated}")
            self.assertTrue((error < 0.003 * value).all(), name)
        for run in ladder:
            self.assertTrue((run["mean_energy_density"]
                             > reference["mean_energy_density"]).all())

    def test_outline(self):
        """From the apex to the edge, which stays; near the committed one."""
        self.grow(Edge_levels=4)
        summary = self.summary()
        points = read_csv(self.work / "run-outline.csv")
        committed = read_csv(DATA / "half-fixed-sphere-outline.csv")
        for row in summary:
            ours = points[points["theta"] == row["theta"]]
            theirs = committed[committed["theta"] == row["theta"]]
            self.assertAlmostEqual(ours["z"][0], row["apex"], 6)
            self.assertAlmostEqual(ours["angle"][-1], math.pi / 2, 9)
            self.assertAlmostEqual(ours["r"][-1], RADIUS, 6)
            self.assertAlmostEqual(ours["z"][-1], 0, 6)
            self.assertTrue((numpy.diff(ours["angle"]) > 0).all())
            for axis in "rz":
                there = numpy.interp(ours["angle"], theirs["angle"],
                                     theirs[axis])
                far = ours["angle"] < math.radians(80)
                self.assertLess(abs(there - ours[axis])[far].max(), 1.0)

    def test_stability(self):
        """No waves around the axis grow at theta = 1.1; before growth each
        mode has the eigenvalue 1."""
        self.grow(Edge_levels=0, Uniform_levels=0, Stability_modes="2, 7",
                  Growth_stretches="1.0, 1.1")
        rows = read_csv(self.work / "run-stability.csv")
        self.assertEqual(list(rows["mode"]), [2, 7, 2, 7])
        for value in rows["smallest_eigenvalue"][:2]:
            self.assertAlmostEqual(value, 1, 6)
        for value in rows["smallest_eigenvalue"][2:]:
            self.assertGreater(value, 0.05)
            self.assertLess(value, 0.9)

    def test_fields(self):
        self.grow(Edge_levels=0, Uniform_levels=0, Growth_stretches="1.1",
                  Write_VTU="true")
        self.assertIn("displacement", (self.work / "run-1.1.vtu").read_text())

    def test_bad_input(self):
        """Exit code 1, key and value on stderr, nothing written."""
        for key, value, allowed in (
                ("Radius", "-1", "> 0"), ("Radius", "wide", "Double"),
                ("Poisson's ratio", "0.5", "below 0.5"),
                ("Growth stretches", "0", "> 0"),
                ("Clamp edge", "250", "between"), ("Degree", "9", "1...8"),
                ("Edge quadrature points", "2", "at least 3"),
                ("Newton tolerance", "0", "above 0"),
                ("Output", "nowhere/run", "cannot be written"),
                ("Radisu", "1", "no such key")):
            with self.subTest(key=key, value=value):
                message = self.grow(code=1, **{key: value}).stderr
                for text in (key, value, allowed):
                    self.assertIn(text, message)
                self.assertEqual(list(self.work.iterdir()), [])
        self.assertIn("--foo", self.grow("--foo", code=1).stderr)
        self.assertIn("Key=value", self.grow("-s", "Radius", code=1).stderr)

