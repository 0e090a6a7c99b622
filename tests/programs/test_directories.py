# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Whose directory it is: runs that would be lost are refused, two runs at once
are refused, files that vanish under a run are noticed.
"""
import os
import re
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

from tests.common.program import ProgramTest, overrides

SCENE = Path(__file__).resolve().parent / "small-cube.prm"
SHORT = overrides({"Time/End time": "0.25"})
FINE = overrides({"Time/Step": 1 / 32, "Output/Snapshot interval": 1 / 8})
PATIENCE = 300  # s, for a machine that has other things to do


class Directories(ProgramTest):
    def setUp(self):
        super().setUp()
        self.output = self.work / "output"

    def content(self):
        return {path: path.read_bytes() for path in self.output.rglob("*")
                if path.is_file()}

    def refused(self, scene, *arguments, texts, ranks=1):
        """Exit code 1, one message with these texts, and nothing touched."""
        before = self.content()
        result = self.execute(scene, *arguments, ranks=ranks, code=1)
        for text in (f"Output directory = '{self.output}': allowed is ",
                     *texts):
            self.assertIn(text, result.stderr)
        self.assertEqual(result.stderr.count("morula: "), 1)
        self.assertEqual(result.stdout, "")
        self.assertEqual(before, self.content())

    def start(self, *arguments, row=2, ranks=1):
        """A run that stands still behind a row of statistics.csv."""
        process = subprocess.Popen(
            self.command(SCENE, "-s", f"Output directory={self.output}", *FINE,
                         *arguments, ranks=ranks),
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        statistics = self.output / "statistics.csv"
        deadline = time.monotonic() + PATIENCE
        while (not statistics.exists()
               or statistics.read_bytes().count(b"\n") < row + 2):
            self.assertIsNone(process.poll(), "ended too early")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        return process

    def end(self, process, code=0):
        process.send_signal(signal.SIGCONT)
        said = process.communicate(timeout=PATIENCE)[1]
        self.assertEqual(process.returncode, code, said)
        return said

    def kill(self, process):
        process.kill()
        process.wait()

    def copied(self, name):
        """The same scene as another file."""
        return Path(shutil.copy(SCENE, self.work / name))

    def test_default_is_named_after_the_scene(self):
        for name in ("bud.prm", "fig-4e-0.95.prm"):
            scene = self.copied(name)
            words = [self.options.morula, scene.name, *SHORT]
            self.run_words(words, cwd=self.work)
            run = self.output / scene.stem
            self.assertTrue((run / "statistics.csv").is_file())
            keys = (run / "parameters.prm").read_text()
            self.assertRegex(keys,
                             f"set Output directory *= output/{scene.stem}\n")
        # an empty value is the default, as --parameters prints it
        empty = overrides({"Output directory": ""})
        self.run_words([self.options.morula, "bud.prm", *SHORT, *empty],
                       cwd=self.work)
        printed = self.run_words([self.options.morula, "--parameters"]).stdout
        self.assertRegex(printed, r"(?m)^set Output directory *= *$")

    def test_a_finished_run_is_repeated(self):
        """By the same scene file, also with other overrides, and by its own
        parameters.prm."""
        self.execute(SCENE, *SHORT)
        first = (self.output / "lineage.csv").read_bytes()
        self.execute(SCENE, *SHORT, *overrides({"Tissue/Cell spacing": "15"}))
        self.assertNotEqual(first, (self.output / "lineage.csv").read_bytes())
        self.execute(self.output / "parameters.prm",
                     *overrides({"Tissue/Cell spacing": "12"}))
        self.assertEqual(first, (self.output / "lineage.csv").read_bytes())
        self.execute(SCENE, *SHORT)
        # in a tree that was moved, too
        for place in ("here", "there"):
            (self.work / place).mkdir()
            scene = shutil.copy(SCENE, self.work / place)
            if place == "there":
                shutil.copytree(self.work / "here/run", self.work / "there/run")
            self.execute(scene, *SHORT, output=self.work / place / "run")

    def test_another_scenes_run_is_kept(self):
        other = self.copied("other.prm")
        self.execute(other, *SHORT)
        (self.output / "notes.txt").write_text("mine\n")
        (self.output / "cells-0000.png").write_text("mine, too\n")
        for ranks in (1, 2):
            self.refused(SCENE, *SHORT, ranks=ranks, texts=(
                "there is one of another scene, '../other.prm'",
                "--replace deletes it", "another directory"))
        # of the same name, elsewhere
        (self.work / "elsewhere").mkdir()
        twin = shutil.copy(other, self.work / "elsewhere")
        self.refused(twin, *SHORT, texts=("'../other.prm'",))
        before = self.content()
        self.execute(SCENE, *SHORT, "--replace")
        after = self.content()
        self.assertEqual(set(before), set(after))
        for name in ("notes.txt", "cells-0000.png"):
            self.assertEqual(before[self.output / name],
                             after[self.output / name])
        self.execute(SCENE, *SHORT)

    def test_an_unfinished_run_is_kept(self):
        self.kill(self.start(row=6))
        lock = self.output / "morula.lock"
        self.assertTrue(lock.exists())  # and is held by nobody any more
        self.refused(SCENE, *FINE, texts=(
            "there is one that is not finished", "--resume goes on with it",
            "--replace deletes it"))
        self.execute(SCENE, *FINE, "--resume")
        self.assertFalse(lock.exists())
        self.execute(SCENE, *FINE)
        # one that has failed
        broken = overrides({"Growth/Law": "isotropic",
                            "Growth/Isotropic/Stretch":
                            "if (t > 0.2 && t < 0.3, log(-1), 1)"})
        self.execute(SCENE, *broken, code=2)
        self.refused(SCENE, *SHORT, texts=("not finished",))
        self.execute(SCENE, *SHORT, "--replace")

    def test_an_unfinished_run_without_snapshot(self):
        self.kill(self.start(row=1))
        self.assertFalse((self.output / "snapshot.h5").exists())
        self.refused(SCENE, *FINE, texts=(
            "there is one that is not finished", "no snapshot to go on from",
            "--replace deletes it"))
        said = self.execute(SCENE, *FINE, "--resume", code=1).stderr
        self.assertIn("with --replace if there are files of it", said)
        self.execute(SCENE, *FINE, "--replace")

    def test_a_long_run_is_kept(self):
        self.execute(SCENE, *SHORT)
        file = self.output / "parameters.prm"
        text, n = re.subn("(# state: finished after ).* s\n", r"\g<1>3700 s\n",
                          file.read_text())
        self.assertEqual(n, 1)
        file.write_text(text)
        self.refused(SCENE, *SHORT, texts=("there is one that took 1 h 01 min",
                                           "--replace deletes it"))
        self.execute(SCENE, *SHORT, "--replace")

    def test_an_older_run_is_kept(self):
        """Of a Morula that wrote no such comments."""
        self.execute(SCENE, *SHORT)
        file = self.output / "parameters.prm"
        file.write_text(file.read_text().replace("#", "# "))
        self.refused(SCENE, *SHORT, texts=("does not say of which scene it is",
                                           "--replace deletes it"))
        self.execute(SCENE, *SHORT, "--replace")

    def test_files_of_no_run_are_never_deleted(self):
        self.output.mkdir()
        (self.output / "log.txt").write_text("my own log\n")
        for arguments in ((), ("--replace",)):
            self.refused(SCENE, *SHORT, *arguments, texts=(
                "there is 'log.txt', but no parameters.prm of such a run",
                "Move such files"))
        (self.output / "log.txt").unlink()
        self.execute(SCENE, *SHORT)

    def test_two_at_once(self):
        process = self.start()
        holder = (f"process {process.pid} on {socket.gethostname()}",
                  "Wait for its end")
        for arguments in ((), ("--replace",), ("--resume",)):
            self.refused(SCENE, *FINE, *arguments, texts=holder)
        self.refused(SCENE, *FINE, "--replace", texts=holder, ranks=2)
        self.end(process)
        whole = self.content()
        self.execute(SCENE, *FINE, output=self.work / "alone")
        self.assertEqual(whole[self.output / "lineage.csv"],
                         (self.work / "alone/lineage.csv").read_bytes())

    def test_two_resumed_at_once(self):
        self.kill(self.start(row=6))
        process = self.start("--resume", row=10)
        self.refused(SCENE, *FINE, "--resume", texts=(
            f"process {process.pid} on {socket.gethostname()}",))
        self.end(process)
        self.assertNotIn("morula.lock", os.listdir(self.output))

    def test_tables_that_vanish(self):
        for name in ("statistics.csv", "lineage.csv"):
            with self.subTest(name):
                process = self.start("--replace")
                (self.output / name).unlink()
                said = self.end(process, code=2)
                self.assertIn(f"{name}' was deleted or replaced while the run "
                              "went on", said)
                self.assertIn("At t = ", said)

    def test_a_directory_that_vanishes(self):
        process = self.start()
        shutil.rmtree(self.output)
        said = self.end(process, code=2)
        # which file notices it first depends on where the run stood still, and
        # whether the background had put the first output in its place
        self.assertRegex(said, r"(statistics|lineage)\.csv' was deleted or "
                         "replaced while the run went on|cannot (open|replace)"
                         r" the file '.*/cells-0000\.csv(\.tmp)?': No such file")
        self.assertFalse(self.output.exists())

    def test_colon(self):
        """MPI-IO takes what stands before a colon for a file system."""
        place = ("-s", f"Output directory={self.work / 'run-12:30'}")
        for ranks in (1, 2):
            self.execute(SCENE, *SHORT, *place, "--replace", ranks=ranks)
            self.assertTrue((self.work / "run-12:30/snapshot.h5").exists())
        self.execute(SCENE, *overrides({"Time/End time": 0.5}), *place,
                     "--resume")

    def test_events_of_an_old_run(self):
        """A new run keeps no table that its own scene does not write."""
        self.execute(SCENE, *SHORT)
        (self.output / "events.csv").write_text("time,cell,event\n")
        self.execute(SCENE, *SHORT)
        self.assertFalse((self.output / "events.csv").exists())

    def test_either_resume_or_replace(self):
        result = self.execute(SCENE, "--resume", "--replace", code=1)
        self.assertIn("leave one of the two out", result.stderr)
        self.assertFalse(self.output.exists())

    def test_temporary_files(self):
        """Two runs at once without mpiexec leave nothing behind: MPI starts no
        daemon for them, which would make directories. Open MPI 5 leaves
        directories without files, whatever it is told."""
        temporary = self.work / "tmp"
        temporary.mkdir()
        runs = [subprocess.Popen(
            self.command(SCENE, "-s", f"Output directory={self.work / name}",
                         *SHORT),
            env={**os.environ, "TMPDIR": str(temporary)},
            stdout=subprocess.DEVNULL) for name in ("one", "other")]
        self.assertEqual([run.wait(PATIENCE) for run in runs], [0, 0])
        version = subprocess.run(["ompi_info", "--version"], check=True,
                                 capture_output=True, text=True).stdout
        left = list(temporary.rglob("*"))
        if "Open MPI v5" in version:
            left = [path for path in left if not path.is_dir()]
        self.assertEqual(left, [])

