# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/sweep: its numbers against those computed here from the runs, runs
that fail, runs that are interrupted, and what it refuses.
"""
import contextlib
import csv
import math
import os
import shutil
import signal
import statistics
import subprocess
import time
from pathlib import Path

from accuracy import DISC
from morula.execute import cores
from morula.sweep.ensemble import summary
from PIL import Image
from tests.common.program import ProgramTest, overrides, read_csv

ROOT = Path(__file__).resolve().parents[2]

RATE = "Proliferation/Cell cycle/G0 exit rate"
VARY = ["--vary", f"{RATE}=1,2", "--vary", "Grid/Spacing=80,40"]
CUBE = ROOT / "tests/programs/small-cube.prm"
PATIENCE = 300  # s, for a machine that has other things to do

# Arguments after the scene, and the texts that the refusal must have.
NONSENSE = {
    "nothing to vary": ([], "--vary", "at least one key", "--seeds"),
    "unknown key": (["--vary", "Grid/Spcing=80,40"], "Grid/Spcing",
                    "Grid/Spacing"),
    "seed as a key": (["--vary", "Random seed=1,2"], "Random seed",
                      "--seeds"),
    "output as a key": (["--vary", "Output/Formats=csv|vtu"],
                        "Output/Formats", "-s"),
    "one value": (["--vary", "Grid/Spacing=80"], "at least two", "-s"),
    "a key twice": ([*VARY, "--vary", "Grid/Spacing=20,10"], "Grid/Spacing",
                    "each key in one"),
    "seeds backwards": ([*VARY, "--seeds", "5-1"], "5-1", "1..5"),
    "seeds in words": ([*VARY, "--seeds", "five"], "five", "1-8"),
    "nothing random": ([*VARY, "--seeds", "1-3", "-s",
                        "Proliferation/Law=none"], "--seeds", "nothing"),
    "too many runs": ([*VARY, "--seeds", "1-999"], "3996 runs", "1000"),
    "column": ([*VARY, "--columns", "cells,total_volum"], "total_volum",
               "total_volume"),
    "column twice": ([*VARY, "--columns", "cells,cells"], "cells,cells",
                     "once"),
    "jobs": ([*VARY, "--jobs", "0"], "--jobs", "'0'", ">= 1"),
    "a value that Morula refuses": (
        ["--vary", "Grid/Spacing=80,-40"], "Grid/Spacing=-40", "> 0"),
    "a combination that Morula refuses": (
        ["--vary", "Tissue/Cell spacing=10,50", "--vary",
         "Tissue/Radius=80,20"], "Tissue/Cell spacing=50",
        "Tissue/Radius=20"),
}


class Sweep(ProgramTest):
    def words(self, scene, *arguments):
        return [str(word) for word in (
            ROOT / "contrib/sweep", scene, "--output", self.work / "found",
            "--morula", self.options.morula, "--mpiexec", self.options.mpiexec,
            *arguments)]

    def sweep(self, scene, *arguments, code=0):
        return self.run_words(self.words(scene, *arguments), code)

    def rows(self, name):
        with (self.work / "found" / name).open(encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_summary(self):
        four = summary([1, 2, 3, 4])
        self.assertEqual((four.n, four.mean, four.smallest, four.largest),
                         (4, 2.5, 1, 4))
        self.assertAlmostEqual(four.deviation, math.sqrt(5 / 3))
        self.assertAlmostEqual(four.error, math.sqrt(5 / 12))
        one = summary([7])
        self.assertEqual((one.n, one.mean), (1, 7))
        self.assertTrue(math.isnan(one.deviation) and math.isnan(one.error))

    def test_combinations(self):
        """Four of them with three seeds, and nothing is run twice."""
        scene = self.write("disc.prm", DISC)
        command = [scene, *VARY, "--seeds", "1-3", "--jobs",
                   min(2, cores()), "--columns", "cells,xmax"]
        self.assertNotIn("from before", self.sweep(*command).stdout)
        runs = self.rows("runs.csv")
        self.assertEqual(len({(row[RATE], row["Grid/Spacing"], row["seed"])
                              for row in runs}), 12)
        for row in runs:
            output = self.work / "found" / row["directory"]
            keys = (output / "parameters.prm").read_text()
            for name in (f"G0 exit rate = {row[RATE]}",
                         f"Spacing = {row['Grid/Spacing']}",
                         f"Random seed = {row['seed']}"):
                self.assertRegex(" ".join(keys.split()), rf"set {name}\b")
            last = read_csv(output / "statistics.csv")[-1]
            for column in ("time", "cells", "xmax", "unknowns"):
                self.assertEqual(float(row[column]), last[column])

        table = self.rows("table.csv")
        for column in ("cells", "xmax"):
            for row in (row for row in table if row["column"] == column):
                ends = [float(run[column]) for run in runs if all(
                    run[key] == row[key] for key in (RATE, "Grid/Spacing"))]
                self.assertEqual((row["runs"], row["failed"]), ("3", "0"))
                deviation = statistics.stdev(ends)
                for name, value in (("mean", statistics.mean(ends)),
                                    ("standard_deviation", deviation),
                                    ("standard_error",
                                     deviation / math.sqrt(3)),
                                    ("smallest", min(ends)),
                                    ("largest", max(ends))):
                    self.assertAlmostEqual(float(row[name]) / value, 1, 8)
        self.assertEqual(len(table), 4 * 33)
        cells = {row[RATE]: float(row["mean"]) for row in table
                 if row["column"] == "cells"}
        self.assertGreater(cells["2"], cells["1"] + 20)

        markdown = (self.work / "found/table.md").read_text(encoding="utf-8")
        self.assertIn("## xmax, um", markdown)
        self.assertEqual(markdown.count("\n| 1 | "), 4)
        with Image.open(self.work / "found/sweep.png") as picture:
            self.assertGreater(picture.size[0], 800)
            self.assertGreater(len(set(picture.convert("RGB").getdata())), 50)

        self.assertEqual(self.sweep(*command).stdout.count("from before"), 12)
        self.assertEqual(self.rows("runs.csv"), runs)

    def test_samples(self):
        """A line of the table is a combination; those that the program refuses
        are left out on request, and told; data files stand beside the scene."""
        folder = self.work / "scene"
        folder.mkdir()
        (folder / "cells.csv").write_text("x,y\n" + "".join(
            f"{10 * i},{10 * j}\n" for i in range(9) for j in range(9)))
        scene = folder / "disc.prm"
        scene.write_text(DISC + """
subsection Tissue
  set Shape = points
  set Points file = cells.csv
end
""")
        table = self.write("samples.csv", f'"{RATE}",Grid/Spacing\n'
                           "1,40\n# a comment\n2,50\n3,-1\n2.5,45\n")
        words = [scene, "--samples", table, "-s", "Time/End time=0.2"]
        refused = self.sweep(*words, code=1).stderr
        self.assertIn("Grid/Spacing=-1", refused)
        self.assertIn("sweep: checking 3 of 4", refused)
        said = self.sweep(*words, "--skip-refused").stdout
        self.assertIn("is left out", said)
        self.assertIn("3 of 3 runs finished", said)
        self.assertEqual([(row[RATE], row["Grid/Spacing"])
                          for row in self.rows("runs.csv")],
                         [("1", "40"), ("2", "50"), ("2.5", "45")])
        first = self.work / "found" / self.rows("runs.csv")[0]["directory"]
        self.execute(scene, *overrides({"Time/End time": "0.2", RATE: "1",
                                        "Grid/Spacing": "40"}))
        self.assert_same_file(first / "lineage.csv",
                              self.work / "output/lineage.csv")
        for text, part in (("Grid/Spacing\n40\n40.0\n", "sample 1"),
                           ("Grid/Spacing\n", "a line of values"),
                           ("Grid/Spcing\n40\n", "Did you mean"),
                           ("Grid/Spacing,Grid/Spacing\n4,5\n", "once"),
                           ("Grid/Spacing,Time/Step\n40\n", "2 values"),
                           ("Random seed\n4\n", "--seeds"),
                           ("Grid/Spacing\n-1\n", "some that Morula")):
            self.write("samples.csv", text)
            self.assertIn(part, self.sweep(*words, "--skip-refused",
                                           code=1).stderr)
        self.assertIn("--vary", self.sweep(
            *words, "--vary", "Grid/Spacing=3,4", code=1).stderr)

    def test_output_in_the_working_directory(self):
        scene = self.write("disc.prm", DISC)
        self.run_words([ROOT / "contrib/sweep", scene, "--seeds", "1,2",
                        "--morula", self.options.morula, "-s",
                        "Time/End time=0.1"], cwd=self.work)
        self.assertTrue((self.work / "output/sweep/disc/table.md").is_file())

    def test_types(self):
        """A key and a column that exist as the scene names types of cells."""
        scene = self.write("types.prm", DISC + """
subsection Cell types
  set Names = stem, leaf
end
""")
        self.sweep(scene, "--vary", "Cell types/stem/Transitions/To leaf=0,5",
                   "--columns", "cells_stem,cells_leaf")
        none, most = ({row["column"]: float(row["mean"])
                       for row in rows} for rows in (
            [row for row in self.rows("table.csv")
             if row["Cell types/stem/Transitions/To leaf"] == rate]
            for rate in ("0", "5")))
        self.assertEqual(none["cells_leaf"], 0)
        self.assertEqual(none["cells_stem"], none["cells"])
        self.assertGreater(most["cells_leaf"], most["cells_stem"])
        self.assertEqual(most["cells_leaf"] + most["cells_stem"], most["cells"])

    def test_runs_that_fail(self):
        """They are told, and the others are done."""
        result = self.sweep(
            ROOT / "tests/scenes/without-extension-fails.prm", "--vary",
            "Grid/Extension=false,true", "--columns", "zmax", code=2)
        self.assertIn("Extension = false", result.stderr)
        self.assertIn("exit code 2", result.stderr)
        self.assertIn("1 of 2 runs finished", result.stdout)
        failed, done = (row for row in self.rows("table.csv")
                        if row["column"] == "zmax")
        self.assertEqual((failed["runs"], failed["failed"]), ("0", "1"))
        self.assertEqual((done["runs"], done["failed"]), ("1", "0"))
        self.assertTrue(math.isnan(float(failed["mean"])))
        self.assertGreater(float(done["mean"]), 0)
        markdown = (self.work / "found/table.md").read_text(encoding="utf-8")
        self.assertIn("## Failed", markdown)
        self.assertIn("0 of 1", markdown)

    def test_interrupted(self):
        """Ended with kill -9 while its run goes on: nobody else may write
        there until that run has ended, too; and then it is resumed."""
        keys = {"Time/Step": "0.03125"}
        command = [CUBE, "--seeds", "4", *overrides(keys)]
        whole = self.work / "whole"
        self.execute(CUBE, *overrides(keys), output=whole)
        process = subprocess.Popen(self.words(*command),
                                   stdout=subprocess.DEVNULL)
        run = self.wait_for_snapshot(process)
        os.kill(run, signal.SIGSTOP)
        process.kill()
        process.wait()
        try:
            self.assertIn("nobody else", self.sweep(*command, code=1).stderr)
        finally:
            os.kill(run, signal.SIGKILL)
        self.wait_until_ended(run)
        self.assertIn("goes on from its snapshot",
                      self.sweep(*command).stdout)
        resumed, = (self.work / "found/runs").glob("*/output")
        self.assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")
        self.assert_same_file(whole / "cells-0002.csv",
                              resumed / "cells-0002.csv")
        self.assert_same_columns(whole / "statistics.csv",
                                 resumed / "statistics.csv",
                                 ignore=["wall_seconds"])

        # a snapshot that cannot be resumed: the run begins anew
        (resumed / "snapshot.h5").write_text("damaged")
        record = resumed.parent / "run.json"
        record.write_text(record.read_text().replace('"exit": 0',
                                                     '"exit": -9'))
        said = self.sweep(*command).stdout
        self.assertIn("goes on from its snapshot", said)
        self.assertIn("1 of 1 runs finished", said)
        self.assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")

    def test_stopped(self):
        """SIGTERM: no run is left over, nothing that has been done is lost."""
        command = [CUBE, "--seeds", "4", *overrides({"Time/Step": "0.03125"})]
        process = subprocess.Popen(self.words(*command), text=True,
                                   stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE)
        run = self.wait_for_snapshot(process)
        process.terminate()
        said = process.communicate(timeout=PATIENCE)[1]
        self.assertEqual(process.returncode, 130)
        self.assertIn("the same command goes on", said)
        self.assertFalse(Path(f"/proc/{run}").exists())
        self.assertIn("goes on from its snapshot",
                      self.sweep(*command).stdout)

    def wait_for_snapshot(self, process):
        """The process id of the only run, once it has written a snapshot."""
        deadline = time.monotonic() + PATIENCE
        runs = self.work / "found/runs"
        while not list(runs.glob("*/output/snapshot.h5")):
            self.assertIsNone(process.poll(), "ended too early")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.002)
        for file in Path("/proc").glob("[0-9]*/cmdline"):
            with contextlib.suppress(OSError):
                words = file.read_bytes().decode(errors="replace").split("\0")
                if words[0] == os.path.realpath(self.options.morula) and any(
                        str(runs) in word for word in words):
                    return int(file.parent.name)
        self.fail("the run has ended too early")
        return None

    def wait_until_ended(self, process_id):
        """And with it the program that has started it, whose record of the
        run is the last that happens."""
        deadline = time.monotonic() + PATIENCE
        while (Path(f"/proc/{process_id}").exists()
               or not list((self.work / "found/runs").glob("*/cost.json"))):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        time.sleep(0.2)

    def test_nonsense(self):
        scene = self.write("disc.prm", DISC)
        for name, (arguments, *texts) in NONSENSE.items():
            with self.subTest(name):
                self.assert_refused(scene, arguments, texts)
        self.assert_refused("nowhere.prm", VARY, ["nowhere.prm", "can be"])
        self.assertFalse((self.work / "found").exists(), "it was written")
        self.assertIn("--sedes", self.sweep(scene, "--sedes", "1-2",
                                            code=1).stderr)

    def assert_refused(self, scene, arguments, texts):
        result = self.sweep(scene, *arguments, code=1)
        self.assertEqual(result.stdout, "")
        for text in ("sweep: ", *texts):
            self.assertIn(text, result.stderr)

    def tearDown(self):
        shutil.rmtree(self.work / "found", ignore_errors=True)

