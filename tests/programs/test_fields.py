# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fields in whole runs: resumed, on several ranks, stopped, in pictures; and
prm/examples/oxygen-limited-spheroid.prm, a small one."""
import numpy
from morula.report import curves
from morula.run import Run

from tests.common.program import TESTS, ProgramTest, overrides, read_csv, \
    without_wall_time

SCENE = TESTS / "programs/small-cube.prm"
SPHEROID = TESTS.parent / "prm/examples/oxygen-limited-spheroid.prm"

# Cells divide where there is much oxygen, towards it, and make a signal.
FIELDS = overrides({
    "Fields/Names": "oxygen, signal",
    "Fields/oxygen/Diffusion": "1e5",
    "Fields/oxygen/Consumption": "6e4/(1 + oxygen)",
    "Fields/oxygen/Fixed where": "Z > 59",
    "Fields/oxygen/Value": "100 - 40*t",
    "Fields/oxygen/Initial": "100",
    "Fields/signal/Time": "transient",
    "Fields/signal/Diffusion": "500*(1 + (X > 0))",
    "Fields/signal/Production": "hill(oxygen, 40, 2)",
    "Fields/signal/Consumption": "0.5",
    "Fields/signal/Transfer": "20*(X > 29)",
    "Proliferation/Cell cycle/G0 exit rate": "2*hill(oxygen, 40, 2)",
    "Proliferation/Cell cycle/Division axis": "gradient of oxygen",
    "Solver/Newton tolerance": "1e-10"})


class Fields(ProgramTest):
    def assert_same_run(self, whole, resumed):
        self.assertEqual(without_wall_time(whole), without_wall_time(resumed))
        for name in ("cells-0002.csv", "lineage.csv", "surface-0002.csv"):
            self.assert_same_file(whole / name, resumed / name)

    def test_resumed_run_is_the_same(self):
        """On one rank and on two."""
        for ranks in (1, 2):
            whole, resumed = (self.work / f"{name}-{ranks}"
                              for name in ("whole", "resumed"))
            self.execute(SCENE, *FIELDS, output=whole, ranks=ranks)
            for arguments in (overrides({"Time/End time": "0.5"}),
                              ["--resume"]):
                self.execute(SCENE, *FIELDS, *arguments, output=resumed,
                             ranks=ranks)
            self.assert_same_run(whole, resumed)
        cells = read_csv(whole / "cells-0002.csv")
        self.assertGreater(numpy.ptp(cells["oxygen"]), 10)
        self.assertGreater(numpy.ptp(cells["signal"]), 0.05)

    def test_resumed_from_the_start(self):
        """A first step that could not be done: what was solved at t = 0 stands
        in the snapshot, and is not solved again."""
        whole, resumed = self.work / "whole", self.work / "resumed"
        fields = [*FIELDS, *overrides({
            "Proliferation/Cell cycle/Start": "together",
            "Time/Smallest step": "0.125"})]
        self.execute(SCENE, *fields, output=whole)
        self.execute(SCENE, *fields, "-s", "Solver/Largest gap=1e-15",
                     output=resumed, code=2)
        self.assertEqual(read_csv(resumed / "statistics.csv").size, 1)
        self.execute(SCENE, *fields, "--resume", output=resumed)
        self.assert_same_run(whole, resumed)

    def test_all_cells_die(self):
        """The fields of no cells are 0, as all else of them."""
        said = self.execute(SCENE, *FIELDS, *overrides({
            "Death/When": "t > 0.3", "Death/Shrinking time": "0"})).text
        self.assertIn("Finished: all cells are dead", said)
        rows = read_csv(self.work / "output/statistics.csv")
        self.assertEqual(rows["cells"][-1], 0)
        for field in ("oxygen", "signal"):
            for what in ("min", "mean", "max"):
                values = rows[f"{field}_{what}"]
                self.assertTrue(numpy.isfinite(values).all(), values)
                self.assertEqual(values[-1], 0)
            self.assertGreater(rows[f"{field}_mean"][-2], 0)

    def test_ranks_agree(self):
        for ranks in (1, 2, 4):
            self.execute(SCENE, *FIELDS, ranks=ranks,
                         output=self.work / str(ranks))
        for ranks in (2, 4):
            one, other = (self.work / name for name in ("1", str(ranks)))
            self.assert_same_columns(one / "lineage.csv",
                                     other / "lineage.csv", {
                                         name: 1e-4 for name in
                                         ("birth_time", "x", "y", "z")})
            for name in ("oxygen", "signal"):
                a, b = (read_csv(run / "cells-0002.csv")[name]
                        for run in (one, other))
                self.assertLess(abs(a - b).max(), 1e-5 * a.max())

    def test_no_value_any_more_in_mid_run(self):
        """The run ends with its state, and what is wrong."""
        said = self.execute(
            SCENE, *FIELDS, "-s", "Fields/signal/Consumption=0.3 - t",
            code=2).text
        self.assertIn("Fields/signal/Consumption = '0.3 - t'", said)
        self.assertIn("a value >= 0 1/day", said)
        self.assertIn("The state is saved in snapshot.h5.", said)
        self.assertTrue((self.work / "output/snapshot.h5").is_file())

    def test_steady_state_without_a_sink_in_mid_run(self):
        said = self.execute(
            SCENE, *overrides({
                "Fields/Names": "oxygen", "Fields/oxygen/Diffusion": "1e5",
                "Fields/oxygen/Consumption": "t < 0.3"}), code=2).text
        self.assertIn("Without a sink a steady field has no level", said)

    def test_a_jump_has_no_steady_state(self):
        said = self.execute(
            SCENE, *FIELDS, "-s",
            "Fields/oxygen/Consumption=1e3*(oxygen > 50)").text
        self.assertEqual(said.count("the field 'oxygen' still changed by"), 1)

    def test_explained(self):
        text = self.execute(SCENE, *FIELDS, "--explain").text
        for words in ("fields                  on   oxygen, signal",
                      "steady, D = 1e5 um^2/day",
                      "100 - 40*t at boundary points where Z > 59",
                      "transfer 20*(X > 29) um/day to 0",
                      "evaluated at each step: oxygen"):
            self.assertIn(words, text)

    def test_spheroid(self):
        """A small one: a rim that grows around cells at rest and a core."""
        self.execute(SPHEROID, *overrides({
            "Tissue/Cell spacing": "20", "Grid/Spacing": "60",
            "Output/Formats": "csv"}))
        run = Run(self.work / "output")
        self.assertEqual(run.field_names, ("oxygen",))
        shown = [curve.title for curve in curves.results(run)]
        self.assertIn("The field oxygen", shown)
        rows, cells = run.statistics, run.cells(-1)
        # In the core, where next to nothing is left.
        self.assertLess((rows["oxygen_clipped"] / rows["cells"]).max(), 0.06)
        # Once in each configuration: that of t = 0 is that of the first step.
        sections = (self.work / "output/timings.csv").read_text().split()
        calls = [line.split(",")[1] for line in sections
                 if line.startswith("fields,")]
        self.assertEqual(calls, [str(len(rows) - 1)])
        r = numpy.linalg.norm(cells[["x", "y", "z"]], axis=1)
        means = [r[cells["type"] == i].mean() for i in range(3)]
        print("mean radii of the types, um:", means)
        self.assertGreater(means[0], means[1])
        self.assertGreater(means[1], means[2])
        volume = rows["total_volume"].to_numpy()
        growth = numpy.log(volume[1:] / volume[:-1])
        print("growth of the first and the last step:", growth[[0, -1]])
        self.assertGreater(growth[0], 1.1 * growth[-1])

