# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Interrupted and resumed runs against the run that nothing interrupted.

On the same number of ranks they agree bit for bit, on others in the lineage.
"""
import re
import signal
import subprocess
import time
from pathlib import Path

import h5py
from tests.common.program import ProgramTest, overrides, read_csv, without_wall_time

from tests.common.sealing import seal

SCENE = Path(__file__).resolve().parent / "small-cube.prm"
SHEET = overrides({"Proliferation/Cell cycle/Size checkpoint": "0.9",
                   "Boundary conditions/Fixed where": "Z <= 0",
                   "Solver/Newton tolerance": "1e-12"})
REFINED = overrides({"Tissue/Refine surface": "true", "Grid/Spacing": "32",
                     "Tissue/Boundary points": "96",
                     "Solver/Newton tolerance": "1e-10"})
SHELL = overrides({"Tissue/Shape": "sphere", "Tissue/Radius": "60",
                   "Tissue/Inner radius": "30", "Grid/Spacing": "20",
                   "Tissue/Cell spacing": "7",
                   "Proliferation/Cell cycle/G0 exit rate": "0",
                   "Growth/Law": "isotropic",
                   "Growth/Isotropic/Stretch": "1 + 0.1*t",
                   "Boundary conditions/Slip where": "",
                   "Boundary conditions/Slip normal": "",
                   "Boundary conditions/Lumen where":
                   "X^2 + Y^2 + (Z - 30)^2 < 45^2",
                   "Boundary conditions/Lumen volume": "1 + t/4"})


class Resume(ProgramTest):
    def assert_same_run(self, whole, resumed):
        """Equal bit for bit, but for the wall time."""
        names = sorted(path.name for path in whole.glob("*.csv"))
        self.assertEqual(
            names, sorted(path.name for path in resumed.glob("*.csv")))
        self.assertIn("cells-0002.csv", names)
        for name in names:
            if name not in ("statistics.csv", "timings.csv"):
                self.assert_same_file(whole / name, resumed / name)
        rows = [without_wall_time(run) for run in (whole, resumed)]
        self.assertEqual(*rows)

    def interrupt_and_resume(self, interruption, *arguments, ranks=1):
        whole, resumed = self.work / "whole", self.work / "resumed"
        self.execute(SCENE, *arguments, ranks=ranks, output=whole)
        self.execute(SCENE, *arguments, *interruption, ranks=ranks,
                     output=resumed)
        rows = len(read_csv(resumed / "statistics.csv"))
        self.assertLess(rows, len(read_csv(whole / "statistics.csv")))
        self.execute(SCENE, *arguments, "--resume", ranks=ranks,
                     output=resumed)
        return whole, resumed

    def test_longer_end_time(self):
        self.assert_same_run(*self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"})))

    def test_longer_end_time_on_two_ranks(self):
        self.assert_same_run(*self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"}), *SHEET, ranks=2))

    def test_carriers_of_held_points(self):
        """In the paper's form held points keep a cell, which may not be the
        nearest one any more."""
        self.assert_same_run(*self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"}), *SHEET,
            *overrides({"Method": "paper"}), ranks=2))
        with h5py.File(self.work / "whole" / "snapshot.h5") as file:
            self.assertIn("carrier 1", str(file["boundary points/columns"][()]))

    def test_condition_estimate(self):
        """condition.csv goes on, too."""
        estimate = overrides({"Output/Condition estimate": "true"})
        self.assert_same_run(*self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"}), *estimate))
        resumed = self.work / "begun-without"
        self.execute(SCENE, *overrides({"Time/End time": "0.5"}),
                     output=resumed)
        self.execute(SCENE, *estimate, "--resume", output=resumed)
        steps = list(read_csv(resumed / "condition.csv")["step"])
        self.assertEqual(steps, [5, 6, 7, 8])

    def test_newton_trace(self):
        """newton.csv goes on, too."""
        self.assert_same_run(*self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"}),
            *overrides({"Output/Newton trace": "true"})))

    def test_timings(self):
        """They count on. A snapshot leaves its own writing out: deal.II sums
        up no timer with an open section."""
        self.execute(SCENE, *overrides({"Output/Snapshot interval": "0.25",
                                        "Output/Formats": "none",
                                        "Time/End time": "0.75"}))
        output = self.work / "output"

        def calls(section):
            for row in (output / "timings.csv").read_text().splitlines():
                if row.startswith(section + ","):
                    return float(row.split(",")[1])
            return 0

        written = calls("snapshot")
        self.assertGreaterEqual(written, 3)
        with h5py.File(output / "snapshot.h5") as file:
            saved = file["numbers"].attrs
            self.assertEqual(saved["calls of snapshot"], written - 1)
            self.assertEqual(saved["calls of tangent"], calls("tangent"))
        before = calls("tangent")
        self.execute(SCENE, "--resume")
        self.assertEqual(calls("snapshot"), written)  # the last was not paid
        self.assertGreater(calls("tangent"), before)

    def test_refined_surface(self):
        """Points are split before and after the interruption."""
        whole, _ = pair = self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"}), *REFINED, ranks=2)
        self.assert_same_run(*pair)
        points = [len(read_csv(whole / f"surface-000{i}.csv"))
                  for i in range(3)]
        self.assertEqual(points, sorted(set(points)))

    def test_lumen(self):
        """Its volume at t = 0 and its pressure are in the snapshot."""
        whole, _ = pair = self.interrupt_and_resume(
            overrides({"Time/End time": "0.5"}), *SHELL, ranks=2)
        self.assert_same_run(*pair)
        rows = read_csv(whole / "statistics.csv")
        volume = rows["lumen_volume"] / rows["lumen_volume"][0]
        self.assertLess(abs(volume / (1 + rows["time"] / 4) - 1).max(), 1e-6)
        self.assertGreater(rows["lumen_pressure"].min(), -0.1)
        self.assertNotEqual(rows["lumen_pressure"][-1], 0)

    def test_snapshot_without_names_of_columns(self):
        """As an older program wrote it."""
        whole, resumed = self.work / "whole", self.work / "resumed"
        self.execute(SCENE, *SHEET, output=whole)
        self.execute(SCENE, *SHEET, *overrides({"Time/End time": "0.5"}),
                     output=resumed)
        with h5py.File(resumed / "snapshot.h5", "r+") as file:
            for points in ("cells", "boundary points"):
                del file[f"{points}/columns"]
        seal(resumed / "snapshot.h5")
        self.execute(SCENE, *SHEET, "--resume", output=resumed)
        self.assert_same_run(whole, resumed)

    def test_stop_at_cells(self):
        whole, resumed = self.work / "whole", self.work / "resumed"
        no_output = overrides({"Output/Interval": "0"})
        self.execute(SCENE, *no_output, output=whole)
        self.execute(SCENE, *no_output, *overrides({"Time/Stop at cells":
                                                    "130"}), output=resumed)
        last = read_csv(resumed / "statistics.csv")[-1]
        self.assertGreaterEqual(last["cells"], 130)
        self.assertLess(last["time"], 1.0)
        before = read_csv(resumed / "statistics.csv")[-2]
        self.assertLess(before["cells"], 130)
        # stopping wrote an output of its own, at a step end of the whole run
        self.execute(SCENE, *no_output, "--resume", output=resumed)
        self.assert_same_file(whole / "cells-0001.csv",
                              resumed / "cells-0002.csv")
        self.assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")

    def test_end_time_between_steps(self):
        """A cut last step: the resumed run goes on to the old step ends."""
        output = self.work / "output"
        self.execute(SCENE, *overrides({"Time/End time": "0.3"}))
        self.execute(SCENE, "--resume")
        times = list(read_csv(output / "statistics.csv")["time"])
        self.assertEqual(times, [0, 0.125, 0.25, 0.3, 0.375, 0.5, 0.625, 0.75,
                                 0.875, 1])

    def test_other_number_of_ranks(self):
        tight = overrides({"Solver/Newton tolerance": "1e-10"})
        half = overrides({"Time/End time": "0.5"})
        whole = self.work / "whole"
        self.execute(SCENE, *tight, output=whole)
        for before, after in ((1, 2), (3, 1)):
            resumed = self.work / f"{before}-{after}"
            self.execute(SCENE, *tight, *half, ranks=before, output=resumed)
            self.execute(SCENE, *tight, "--resume", ranks=after,
                         output=resumed)
            self.assert_same_columns(whole / "lineage.csv",
                                     resumed / "lineage.csv",
                                     {"x": 1e-6, "y": 1e-6, "z": 1e-6})

    def test_other_step(self):
        self.execute(SCENE, *overrides({"Time/End time": "0.5"}))
        self.execute(SCENE, "--resume", *overrides({"Time/Step": "0.25"}))
        times = list(read_csv(self.work / "output/statistics.csv")["time"])
        self.assertEqual(times, [0, 0.125, 0.25, 0.375, 0.5, 0.75, 1])

    def test_step_too_long_for_the_cycle(self):
        self.execute(SCENE, *overrides({"Time/End time": "0.5"}))
        before = (self.work / "output/statistics.csv").read_bytes()
        result = self.execute(SCENE, "--resume",
                              *overrides({"Time/Step": "0.6"}), code=1)
        self.assertIn("Time/Step", result.stderr)
        self.assertEqual(
            before, (self.work / "output/statistics.csv").read_bytes())

    def test_other_output_interval(self):
        self.execute(SCENE, *overrides({"Time/End time": "0.5",
                                        "Output/Interval": "0.125"}))
        self.execute(SCENE, "--resume", *overrides({"Output/Interval": "0.25"}))
        times = [read_csv(path)["time"][0] for path in
                 sorted((self.work / "output").glob("cells-*.csv"))]
        self.assertEqual(times, [0, 0.125, 0.25, 0.375, 0.5, 0.75, 1])

    def test_other_format(self):
        """The run says which states are not in the new series."""
        half = overrides({"Time/End time": "0.5", "Output/Interval": "0.25"})
        self.execute(SCENE, *half)
        result = self.execute(SCENE, "--resume", *overrides(
            {"Output/Formats": "vtu", "Output/Interval": "0.25"}))
        said = ("3 of the 3 states so far are not there as vtu; cells.pvd and "
                "surface.pvd are without them.")
        output = self.work / "output"
        self.assertIn(said, result.stdout)
        self.assertIn(said, (output / "log.txt").read_text())
        for stem in ("cells", "surface"):
            listed = re.findall(r'file="(.*?)"',
                                (output / f"{stem}.pvd").read_text())
            self.assertEqual(listed, [f"{stem}-0003.vtu", f"{stem}-0004.vtu"])
        self.assertNotIn("states so far", self.execute(
            SCENE, "--resume", *overrides({
                "Output/Formats": "csv, vtu", "Time/End time": "1"})).stdout)

    def test_failure_is_logged(self):
        result = self.execute(
            SCENE, *overrides({"Growth/Law": "isotropic",
                               "Growth/Isotropic/Stretch":
                               "if (t > 0.2 && t < 0.3, log(-1), 1)"}), code=2)
        log = (self.work / "output/log.txt").read_text()
        for text in (result.stderr, log):
            self.assertIn("t = 0.125 day", text)
            self.assertIn("Growth/Isotropic/Stretch", text)

    def test_finished_run(self):
        short = overrides({"Time/End time": "0.25"})
        self.execute(SCENE, *short)
        files = {path.name: path.read_bytes()
                 for path in (self.work / "output").iterdir()}
        self.execute(SCENE, *short, "--resume")
        for name in ("statistics.csv", "lineage.csv", "snapshot.h5"):
            self.assertEqual(files[name],
                             (self.work / "output" / name).read_bytes(), name)

    def test_no_snapshot(self):
        result = self.execute(SCENE, "--resume", code=1)
        self.assertIn("snapshot.h5", result.stderr)
        self.assertFalse((self.work / "output").exists())

    def test_changed_key(self):
        short = overrides({"Time/End time": "0.25"})
        self.execute(SCENE, *short)
        before = (self.work / "output/statistics.csv").read_bytes()
        for key, value in (("Grid/Spacing", "34"), ("Random seed", "5"),
                           ("Proliferation/Cell cycle/Duration", "1.5"),
                           ("Material/Young's modulus", "2")):
            with self.subTest(key):
                result = self.execute(SCENE, "--resume",
                                      *overrides({key: value}), code=1)
                self.assertIn(key, result.stderr)
                self.assertIn(value, result.stderr)
        self.assertEqual(
            before, (self.work / "output/statistics.csv").read_bytes())

    def test_killed(self):
        """kill -9 in mid-run: the last snapshot is whole and goes on to the
        uninterrupted result."""
        whole, killed = self.work / "whole", self.work / "killed"
        fine = overrides({"Time/Step": "0.03125",
                          "Output/Snapshot interval": "0.1"})
        self.execute(SCENE, *fine, output=whole)
        process = subprocess.Popen(
            self.command(SCENE, "-s", f"Output directory={killed}", *fine),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        statistics = killed / "statistics.csv"
        deadline = time.monotonic() + 100
        while (not statistics.exists() or
               statistics.read_bytes().count(b"\n") < 12):
            self.assertIsNone(process.poll(), "ended before it was killed")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.002)
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertLess(len(read_csv(statistics)), 33)
        self.assertTrue((killed / "snapshot.h5").exists())
        self.execute(SCENE, *fine, "--resume", output=killed)
        self.assert_same_run(whole, killed)

