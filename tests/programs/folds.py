#!/usr/bin/python3
# ranks: 2
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Rings and layers that fold: equilibria that halved steps do not find."""
import numpy

from program import (TESTS, ProgramTest, main, overrides, read_csv,
                     without_wall_time)

HARD = TESTS.parent / "prm/hard"
RING = HARD / "folding-ring.prm"


class Folds(ProgramTest):
    def rows(self, name="statistics"):
        return read_csv(self.work / f"output/{name}.csv")

    def test_a_ring_folds(self):
        """Without friction it takes two lobes, with friction more, wherever the
        grid lies; no step is halved."""
        for friction, lobes in (("0", 2), ("1e-5", 4)):
            for offset in ("0, 0", "3, 7"):
                self.execute(RING, "--replace", *overrides(
                    {"Tissue/Cell spacing": "3.3", "Time/End time": "1",
                     "Output/Interval": "1", "Grid/Offset": offset,
                     "Friction/Coefficient": friction}))
                rows = self.rows()
                self.assertEqual(rows["rejected_steps"].sum(), 0)
                worst = numpy.sort(rows["newton_iterations"])[-10:]
                self.assertLessEqual(worst.mean(), 60)
                self.assertGreater(self.rows("newton")["energy"].min(), 0)
                surface = self.rows("surface-0001")
                outer = surface[numpy.hypot(surface["X"], surface["Y"]) > 90]
                self.assertEqual(self.lobes(outer), lobes, (friction, offset))

    @staticmethod
    def lobes(points):
        """The strongest wave of the radius along the ring."""
        angle = numpy.arctan2(points["Y"], points["X"])
        order = numpy.argsort(angle)
        radius = numpy.hypot(points["x"], points["y"])[order]
        around = numpy.linspace(-numpy.pi, numpy.pi, 512, endpoint=False)
        values = numpy.interp(around, angle[order], radius,
                              period=2 * numpy.pi)
        return 1 + numpy.abs(numpy.fft.rfft(values))[1:20].argmax()

    def test_unequal_volumes_are_named(self):
        """Neighbours that do and do not grow, each with its own strain."""
        text = self.execute(RING, "--explain").stdout
        self.assertIn("Material/Volumetric strain = pooled", text)
        self.assertIn("a lumen whose volume is given", text)
        self.assertIn("founders grow unequally", text)

    def test_a_patch_between_walls(self):
        """Held points are squeezed where a layer folds at its walls: the energy
        stays that of an elastic body, and no step is halved."""
        self.execute(HARD / "folding-patch.prm", *overrides(
            {"Tissue/Size": "60, 60, 80", "Tissue/Cell spacing": "7.5",
             "Grid/Spacing": "22", "Time/End time": "0.5",
             "Boundary conditions/Slip where":
                 "abs(X) > 29.9 || abs(Y) > 29.9"}))
        self.assertEqual(self.rows()["rejected_steps"].sum(), 0)
        self.assertGreater(self.rows("newton")["energy"].min(), 0)

    def test_a_pressure_that_jumps(self):
        """One proximal path finds the same state on any ranks, and after a run
        was resumed."""
        jump = HARD / "jumping-pressure.prm"
        whole, resumed = self.work / "whole", self.work / "resumed"
        self.execute(jump, output=whole)
        rows = read_csv(whole / "statistics.csv")
        self.assertEqual(rows["proximal_paths"].sum(), 1)
        self.execute(jump, *overrides({"Time/End time": "0.4"}),
                     output=resumed)
        self.execute(jump, "--resume", output=resumed)
        self.assertEqual(*[without_wall_time(run) for run in (whole, resumed)])
        self.execute(jump, ranks=2)
        for column in ("total_volume", "mean_energy_density", "ymax"):
            numpy.testing.assert_allclose(
                self.rows()[column][-1], rows[column][-1], rtol=1e-5)

    def test_jumps_of_all_kinds(self):
        """A traction, a clamp and growth that jump are found, too."""
        base = {"Boundary conditions/Pressure where": "",
                "Boundary conditions/Pressure": "0"}
        for kind in (
                {"Boundary conditions/Traction where": "Y > 49.9",
                 "Boundary conditions/Traction": "0; -0.3*(t > 0.45)"},
                {"Boundary conditions/Fixed where": "abs(Y) > 49.9",
                 "Boundary conditions/Displacement":
                 "0; -40*(t > 0.45)*(Y > 0)"},
                {"Growth/Law": "isotropic",
                 "Growth/Isotropic/Stretch": "1 + (t > 0.45)"}):
            self.execute(HARD / "jumping-pressure.prm", "--replace",
                         *overrides({**base, **kind}))


if __name__ == "__main__":
    main()
