# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Combinations of effects whose parts are tested elsewhere: what one of them
remembers, the other one must not forget."""
import numpy as np
from morula.execute import overrides
from morula.run import Run
from tests.common.program import ProgramTest, without_wall_time

BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Output/Formats": "none"}


class Unseen(ProgramTest):
    def run_keys(self, keys, name="output", arguments=(), ranks=1):
        self.execute(self.write(f"{name}.prm", ""), *overrides({**BOX, **keys}),
                     *arguments, output=self.work / name, ranks=ranks)
        return Run(self.work / name)

    def test_growth_by_rates_that_relaxes(self):
        """Between plates, growth at a rate is that by the stretch exp(r t/2),
        and the tissue's shear has all but gone long after growth has ended."""
        keys = {"Time/End time": 2, "Time/Step": 0.05, "Output/Interval": 0.5,
                "Material/Relaxation time": 0.2,
                "Material/Energy per": "grown volume",
                "Boundary conditions/Slip where": "abs(Y) > 49.9"}
        laws = {"rate": {"Growth/Law": "rate",
                         "Growth/Rate/Rate": "0.4*(t < 1)"},
                "stretch": {"Growth/Law": "isotropic",
                            "Growth/Isotropic/Stretch":
                                "exp(0.2*min(t, 1))"}}
        runs = {name: self.run_keys({**keys, **law}, name)
                for name, law in laws.items()}
        forces = {name: run.forces["force_inward"].to_numpy()
                  for name, run in runs.items()}
        np.testing.assert_allclose(forces["rate"], forces["stretch"], rtol=0.03,
                                   atol=0.01 * forces["stretch"].max())
        self.assertGreater(forces["rate"][1], 1)
        self.assertLess(forces["rate"][-1], 0.05 * forces["rate"][1])

    def test_every_wait_begins_anew(self):
        """A rate that is found in steps gives what a number gives."""
        keys = {"Time/End time": 2, "Time/Step": 0.1,
                "Proliferation/Law": "cell cycle",
                "Proliferation/Cell cycle/Duration": 0.4}
        born = [self.run_keys({**keys, "Proliferation/Cell cycle/G0 exit rate":
                               rate}, f"rate-{number}").lineage.birth_time
                for number, rate in enumerate(("1.5", "1.5 + 0*t"))]
        self.assertGreater(len(born[0]), 300)
        self.assertEqual(len(born[0]), len(born[1]))
        np.testing.assert_allclose(born[0], born[1], atol=1e-9)

    def test_uptake_that_depends_on_its_field(self):
        """c' = -c^2/2 everywhere: c = 2/(1 + t)."""
        for step in (0.05, 0.025):
            table = self.run_keys({
                "Time/End time": 1, "Time/Step": step, "Fields/Names": "u",
                "Fields/u/Time": "transient", "Fields/u/Diffusion": 100,
                "Fields/u/Initial": 2, "Fields/u/Consumption": "0.5*u"},
                f"step-{step}").statistics
            exact = 2 / (1 + table["time"])
            np.testing.assert_allclose(table["u_mean"], exact, rtol=0.6 * step)
            np.testing.assert_allclose(table["u_max"], table["u_min"],
                                       rtol=1e-6)

    def test_transfer_is_that_of_the_end(self):
        table = self.run_keys({
            "Time/End time": 0.6, "Time/Step": 0.1, "Fields/Names": "u",
            "Fields/u/Time": "transient", "Fields/u/Diffusion": 1000,
            "Fields/u/Initial": 1, "Fields/u/Value": 0,
            "Fields/u/Transfer": "1000*(t > 0.45)"}).statistics
        mean = table.set_index("step")["u_mean"]
        self.assertAlmostEqual(mean[4], 1, places=9)
        self.assertLess(mean[5], 0.9)

    def test_what_goes_along_when_cells_change_places(self):
        """A field that hardly spreads stays with its cell, or with its place,
        and its amount is kept."""
        keys = {"Time/End time": 1, "Time/Step": 0.1, "Output/Formats": "csv",
                "Cell types/Names": "a, b", "Cell types/b/Where": "X > 0",
                "Rearrangement/Diffusion": 200, "Fields/Names": "u",
                "Fields/u/Time": "transient", "Fields/u/Diffusion": 1e-6,
                "Fields/u/Initial": "1 + (X > 0)"}
        for along in (True, False):
            cells = self.run_keys({**keys, "Fields/u/Exchanged": str(along).lower()},
                                  f"along-{along}").cells(-1)
            is_right = (cells.x > 0).to_numpy()
            is_b = (cells.type == 1).to_numpy()
            self.assertGreater((is_right & ~is_b).sum(), 3)
            np.testing.assert_allclose(
                cells.u, 1 + (is_b if along else is_right), rtol=1e-6)
            self.assertAlmostEqual((cells.u * cells.volume).sum(), 15000,
                                   places=5)

    def test_cells_that_are_held_die(self):
        """The run goes on without what held or loaded the tissue, and says
        so, on any ranks; with some of the cells left it says nothing."""
        keys = {"Time/End time": 0.3, "Time/Step": 0.1,
                "Output/Interval": 0.1,
                "Death/Shrinking time": 0,
                "Boundary conditions/Fixed where": "X < -49.9",
                "Boundary conditions/Pressure where": "X > 49.9",
                "Boundary conditions/Pressure": 0.05,
                "Fields/Names": "u", "Fields/u/Diffusion": 1e4,
                "Fields/u/Consumption": 1, "Fields/u/Value": 1,
                "Fields/u/Fixed where": "X < -49.9"}
        word = "acts on no boundary point any more, and did on 10 before"
        for when, ranks, lost in (("X < 0", 1, "fixed"), ("X < 0", 2, "fixed"),
                                  ("X > 0", 1, "pressure"), ("Y > 0", 1, None)):
            run = self.run_keys({**keys, "Death/When": f"{when} && t > 0.05"},
                                f"die-{when[0]}-{ranks}-{lost}", ranks=ranks)
            log = (run.directory / "log.txt").read_text()
            self.assertEqual(log.count(word),
                             {"fixed": 2, "pressure": 1}.get(lost, 0))
            self.assertEqual(f"Fields/u/Fixed where {word}" in log,
                             lost == "fixed")
            if lost:
                self.assertIn(f"{lost} {word}", log)
                forces = run.forces[run.forces.name == lost]
                self.assertEqual(list(forces.points), [10, 0, 0])
            self.assertEqual(len(run.statistics), 4)

    def test_lumen_resumed(self):
        keys = {"Tissue/Shape": "sphere", "Tissue/Radius": 100,
                "Tissue/Inner radius": 60, "Tissue/Cell spacing": 6,
                "Grid/Spacing": 20, "Time/Step": 0.1, "Output/Formats": "csv",
                "Output/Interval": 0.1,
                "Boundary conditions/Lumen where": "X^2 + Y^2 < 80^2",
                "Boundary conditions/Lumen volume": "1 + 0.5*t"}
        whole = self.run_keys({**keys, "Time/End time": 0.4}, "whole")
        self.run_keys({**keys, "Time/End time": 0.2}, "part")
        part = self.run_keys({**keys, "Time/End time": 0.4}, "part",
                             ["--resume"])
        self.assertEqual(without_wall_time(whole.directory),
                         without_wall_time(part.directory))
        for name in ("cells-0004.csv", "surface-0004.csv", "forces.csv"):
            self.assert_same_file(whole.directory / name, part.directory / name)

