# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs that are ended from outside at any moment, and resumed: the result is
that of the run that nothing interrupted, and at most one snapshot interval is
computed again.
"""
import ctypes
import os
import random
import select
import signal
import struct
import subprocess
import time
from pathlib import Path

import h5py
from tests.common.program import ProgramTest, overrides, read_csv, without_wall_time

SCENE = Path(__file__).resolve().parent / "small-cube.prm"
STEP, INTERVAL = 1 / 32, 1 / 8
FINE = overrides({"Time/Step": STEP, "Output/Snapshot interval": INTERVAL})
N_ROWS = 1 + round(1 / STEP)
SEED = 20261
# Cells also die, and live on what diffuses.
DYING = overrides({
    "Material/Energy per": "grown volume", "Death/Rate": "oxygen > 0.3",
    "Death/Shrinking time": 0.2, "Fields/Names": "oxygen",
    "Fields/oxygen/Time": "transient", "Fields/oxygen/Diffusion": 2e4,
    "Fields/oxygen/Consumption": 20, "Fields/oxygen/Initial": 1,
    "Fields/oxygen/Fixed where": 1, "Fields/oxygen/Value": 1})
PATIENCE = 300  # s, for a machine that has other things to do


class NewFiles:
    """Waits for files to appear in a directory (Linux inotify, which Python's
    library does not have): a look now and then would miss the moment."""

    CREATE = 0x100
    HEAD = struct.Struct("iIII")

    def __init__(self, directory):
        libc = ctypes.CDLL(None, use_errno=True)
        self.descriptor = libc.inotify_init()
        if libc.inotify_add_watch(self.descriptor, os.fsencode(directory),
                                  self.CREATE) < 0:
            raise OSError(ctypes.get_errno(), "inotify_add_watch")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.descriptor)

    def wait(self, name, times, timeout):
        """Returns when a file of this name has been made so many times; false
        if that did not happen in time."""
        end = time.monotonic() + timeout
        while select.select([self.descriptor], [], [],
                            max(0, end - time.monotonic()))[0]:
            data, at = os.read(self.descriptor, 65536), 0
            while at < len(data):
                *_, length = self.HEAD.unpack_from(data, at)
                at += self.HEAD.size + length
                times -= data[at - length:at].rstrip(b"\0") == name.encode()
            if times <= 0:
                return True
        return False


class Killed(ProgramTest):
    def start(self, output, *arguments, ranks=1, stderr=subprocess.DEVNULL):
        return subprocess.Popen(
            self.command(SCENE, "-s", f"Output directory={output}", *FINE,
                         *arguments, ranks=ranks),
            stdout=subprocess.DEVNULL, stderr=stderr,
            text=stderr == subprocess.PIPE)

    def wait_for_row(self, process, output, row):
        statistics = output / "statistics.csv"
        deadline = time.monotonic() + PATIENCE
        while (not statistics.exists()
               or statistics.read_bytes().count(b"\n") < row + 2):
            self.assertIsNone(process.poll(), "ended before its signal")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.001)

    def interrupt(self, output, row, delay, arguments=()):
        """Kills a run some time after a row of statistics.csv was written;
        whether that was before the end of the run."""
        process = self.start(output, *arguments)
        try:
            self.wait_for_row(process, output, row)
            time.sleep(delay)
        finally:
            process.kill()
            process.wait()
        return process.returncode != 0

    def assert_little_lost(self, output):
        """The snapshot is at most one interval behind the last row."""
        with h5py.File(output / "snapshot.h5") as file:
            saved = float(file.attrs["time"])
        last = last_time(output / "statistics.csv")
        self.assertLessEqual(last - saved, INTERVAL + 1e-9 * STEP)

    def resume(self, output, *arguments, ranks=1):
        """Resumes a run, or begins it anew if it has no snapshot, as the
        program asks for."""
        anew = not (output / "snapshot.h5").exists()
        if anew:
            refused = self.execute(SCENE, *FINE, *arguments, "--resume",
                                   output=output, code=1)
            self.assertIn("start the run without --resume", refused.stderr)
            self.assertLess(
                last_time(output / "statistics.csv"),
                INTERVAL + STEP)
        else:
            self.assert_little_lost(output)
        self.execute(SCENE, *FINE, *arguments,
                     "--replace" if anew else "--resume",
                     output=output, ranks=ranks)
        self.assertEqual(list(output.glob("*.tmp")), [])

    def assert_same_run(self, whole, resumed):
        """Equal bit for bit, but for the wall time."""
        names = {path.name for path in whole.glob("*.csv")}
        self.assertLessEqual({"lineage.csv", "cells-0000.csv",
                              "cells-0001.csv", "cells-0002.csv",
                              "surface-0002.csv"}, names)
        for name in names - {"statistics.csv", "timings.csv"}:
            self.assert_same_file(whole / name, resumed / name)
        rows = [without_wall_time(run) for run in (whole, resumed)]
        self.assertEqual(len(rows[0]), 1 + N_ROWS)
        self.assertEqual(*rows)

    def whole(self, *arguments):
        output = self.work / "whole"
        self.execute(SCENE, *FINE, *arguments, output=output)
        return output

    def kill_at_random(self, *arguments):
        """Kills ten runs at moments that are drawn, and resumes them; returns
        the run that nothing interrupted."""
        whole, chance, killed = self.whole(*arguments), random.Random(SEED), 0
        print(f"seed {SEED}")
        for n in range(10):
            row, delay = chance.randint(0, 29), chance.uniform(0, 0.03)
            print(f"kill -9 {delay * 1e3:.1f} ms after row {row}", flush=True)
            output = self.work / f"killed-{n}"
            with self.subTest(row=row, delay=delay):
                killed += self.interrupt(output, row, delay, arguments)
                self.resume(output, *arguments)
                self.assert_same_run(whole, output)
        # on a machine that stands still in between, a run may be faster
        self.assertGreaterEqual(killed, 7)
        return whole

    def test_at_random(self):
        self.kill_at_random()

    def test_at_random_where_cells_die(self):
        whole = self.kill_at_random(*DYING)
        events = (whole / "events.csv").read_text()
        self.assertGreater(events.count("death"), 10)
        self.assertGreater(events.count("removal"), 10)

    def test_while_a_snapshot_is_written(self):
        """snapshot.h5.tmp is there and incomplete or not yet renamed."""
        whole, chance, hit = self.whole(), random.Random(SEED), 0
        # The file is made twice each time: to reserve the space, and to write.
        # A busy machine wakes this process too late for most: then more tries.
        for n, made in enumerate(3 * (2, 4, 7, 14, 12)):
            if n >= 5 and hit >= 3:
                break
            output = self.work / f"killed-{n}"
            output.mkdir()
            delay = chance.uniform(0, 0.004)
            print(f"kill -9 {delay * 1e3:.1f} ms after {made} times "
                  "snapshot.h5.tmp", flush=True)
            with NewFiles(output) as files, \
                    self.subTest(made=made, delay=delay):
                process = self.start(output)
                try:
                    self.assertTrue(files.wait("snapshot.h5.tmp", made,
                                               PATIENCE))
                    time.sleep(delay)
                finally:
                    process.kill()
                    process.wait()
                hit += (output / "snapshot.h5.tmp").exists()
                self.resume(output)
                self.assert_same_run(whole, output)
        self.assertGreaterEqual(hit, 3)

    def test_that_leave_a_semaphore_locked(self):
        """Open MPI's own way to files has a semaphore of the machine for every
        file name, and a killed run can leave it locked: whoever waits for it
        waits for ever."""
        libc = ctypes.CDLL(None, use_errno=True)
        libc.sem_open.restype = ctypes.c_void_p
        name = b"/OMPIO_snapshot.h5.tmp"
        libc.sem_unlink(name)
        self.assertTrue(libc.sem_open(name, os.O_CREAT, 0o600, 0))
        try:
            own = {key: value for key, value in os.environ.items()
                   if "romio" not in key}
            words = self.command(SCENE, "-s", "Time/End time=0.25", "-s",
                                 f"Output directory={self.work / 'output'}")
            subprocess.run(words, env=own, check=True, timeout=PATIENCE,
                           stdout=subprocess.DEVNULL)
        finally:
            libc.sem_unlink(name)
        self.assertTrue((self.work / "output/snapshot.h5").is_file())

    def test_on_another_number_of_ranks(self):
        """Killed on one, resumed on two."""
        tight = overrides({"Solver/Newton tolerance": "1e-10"})
        whole, output = self.whole(*tight), self.work / "killed"
        self.assertTrue(self.interrupt(output, 14, 0, arguments=tight))
        self.resume(output, *tight, ranks=2)
        near = {"x": 1e-6, "y": 1e-6, "z": 1e-6}
        self.assert_same_columns(whole / "lineage.csv", output / "lineage.csv",
                                 near)
        cells = [read_csv(run / "cells-0002.csv") for run in (whole, output)]
        for name in ("id", "parent", "generation", "phase"):
            self.assertEqual(list(cells[0][name]), list(cells[1][name]), name)
        for name, tolerance in near.items():
            self.assertLessEqual(abs(cells[0][name] - cells[1][name]).max(),
                                 tolerance, name)

    def asked(self, number, output, ranks=1):
        """What a run that is asked to end says; nothing that was computed is
        lost then."""
        with self.start(output, ranks=ranks,
                        stderr=subprocess.PIPE) as process:
            self.wait_for_row(process, output, 11)
            process.send_signal(number)
            said = process.communicate(timeout=PATIENCE)[1]
        with h5py.File(output / "snapshot.h5") as file:
            self.assertEqual(file.attrs["time"],
                             last_time(output / "statistics.csv"))
        self.assertIn("stopping after this step", said)
        self.assertIn(f"by {signal.Signals(number).name}. The state is saved "
                      "in snapshot.h5.", said)
        self.assertIn("--resume' goes on from there", said)
        self.assertIn("Stopped at t = ", (output / "log.txt").read_text())
        return process.returncode

    def test_asked_to_end(self):
        """Ctrl-C, and SIGTERM or SIGUSR1 as batch systems send them: the run
        saves its state and ends by the signal, as shells expect."""
        whole = self.whole()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1):
            with self.subTest(number.name):
                output = self.work / number.name
                self.assertEqual(self.asked(number, output), -number)
                self.resume(output)
                self.assert_same_run(whole, output)

    def test_ranks_asked_to_end(self):
        """mpiexec hands SIGUSR1 on to the ranks."""
        output = self.work / "output"
        self.assertNotEqual(self.asked(signal.SIGUSR1, output, ranks=2), 0)
        self.resume(output, ranks=2)

    def test_asked_twice(self):
        """The second signal ends the run at once, in the middle of a step."""
        output = self.work / "output"
        with self.start(output, "-s", "Tissue/Cell spacing=2.5",
                        stderr=subprocess.PIPE) as process:
            self.wait_for_row(process, output, 1)
            process.send_signal(signal.SIGTERM)
            heard = b""
            while b"at once" not in heard:
                heard += os.read(process.stderr.fileno(), 4096)
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(PATIENCE), -signal.SIGTERM)
        self.assertFalse((output / "snapshot.h5").exists())


def last_time(file):
    """The last time in statistics.csv; a line may be cut off; 0 without."""
    text = file.read_text() if file.exists() else ""
    lines = text[:text.rfind("\n") + 1].splitlines()[1:]
    return float(lines[-1].split(",")[1]) if lines else 0.0

