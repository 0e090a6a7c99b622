#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/showcase/spheroid.prm beside Greenspan's equations, on a coarser lattice and
for some days in which all three zones are there."""
import numpy
from program import TESTS, ProgramTest, main, overrides
from upkeep.showcase.greenspan import Parameters, course, radii
from upkeep.showcase.spheroids import (LINES, SCENE, all_series,
                                       radii_of_run)

COARSE = {"Tissue/Cell spacing": "20", "Grid/Spacing": "60",
          "Proliferation/Cell cycle/G0 exit rate":
          "20*(volume > 8000*(1 + noise))", "Death/When": "volume < 800",
          "Output/Formats": "csv", "Time/End time": "6"}


class Showcase(ProgramTest):
    def test_spheroid(self):
        series = all_series()[0]
        self.execute(SCENE, *overrides(COARSE))
        times, found = radii_of_run(self.work / "output")
        exact = series.greenspan(times + series.days[0])
        off = (found - exact)[:, 1:] / exact[0, 1:]
        print("R, R_n, R_i off, of R:", abs(off).max(axis=1))
        self.assertGreater(exact[1, -1], 80)
        self.assertLess(abs(off[0]).max(), 0.02)
        self.assertLess(abs(off[1]).max(), 0.03)

    def test_the_scene_is_that_of_its_series(self):
        """The numbers of the file are those that the tool would set."""
        series = all_series()[0]
        self.assertEqual(series.name, "WM983b, 2500 cells")
        explained = [self.execute_explain(*words) for words in
                     ((), overrides(series.overrides()))]
        self.assertEqual(*explained)

    def execute_explain(self, *words):
        return self.run_words([self.options.morula, SCENE, "--explain",
                               *words]).stdout

    def test_equations(self):
        """Where oxygen is too little, by its profile in a ball that uses it up
        at one rate outside the necrotic core: c = 1 - (R² - r² - 2 R_n³ (1/r -
        1/R))/R_c² has there neither flux nor oxygen, and at R_i 1 - R_d²/R_c²."""
        line = LINES["WM983b"]
        outer, necrotic, arrested = radii([300.0], line)[:, 0]

        def oxygen(r):
            return 1 - (outer**2 - r**2 - 2 * necrotic**3
                        * (1 / r - 1 / outer)) / line.necrosis**2
        self.assertAlmostEqual(oxygen(necrotic), 0, 9)
        slope = (oxygen(necrotic + 1e-3) - oxygen(necrotic - 1e-3)) / 2e-3
        self.assertAlmostEqual(slope, 0, 9)
        self.assertAlmostEqual(
            oxygen(arrested), 1 - (line.arrest / line.necrosis)**2, 9)

    def test_growth_without_limit(self):
        """R grows as exp(s t/3) while all cells have oxygen."""
        days = numpy.array([0.0, 1.0, 2.0])
        grown = course(10.0, days, Parameters(200.0, 150.0, 0.4, 0.2))[0]
        self.assertLess(abs(grown / (10 * numpy.exp(0.4 * days / 3))
                            - 1).max(), 1e-7)


if __name__ == "__main__":
    main()
