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
import shutil
import signal
import struct
import subprocess
import time

import h5py
import pytest
from morula.execute import environment
from morula.run import Run

from tests.common.program import TESTS, assert_same_run, overrides, without_wall_time

SCENE = TESTS / "programs/small-cube.prm"
STEP, INTERVAL = 1 / 32, 1 / 8
FINE = {"Time/Step": STEP, "Output/Snapshot interval": INTERVAL}
SEED = 20261
DYING = {"Death/Rate": "oxygen > 0.3",
         "Death/Shrinking time": 0.2, "Fields/Names": "oxygen",
         "Fields/oxygen/Time": "transient", "Fields/oxygen/Diffusion": 2e4,
         "Fields/oxygen/Consumption": 20, "Fields/oxygen/Initial": 1,
         "Fields/oxygen/Fixed where": 1, "Fields/oxygen/Value": 1}
PATIENCE = 300  # s, for a machine that has other things to do


class NewFiles:
    """Waits for files to appear in a directory (Linux inotify, which Python's
    library does not have): a look now and then would miss the moment."""

    CREATE = 0x100
    HEAD = struct.Struct("iIII")

    def __init__(self, directory):
        libc = ctypes.CDLL(None, use_errno=True)
        self.descriptor = libc.inotify_init()
        if libc.inotify_add_watch(self.descriptor, os.fsencode(directory), self.CREATE) < 0:
            raise OSError(ctypes.get_errno(), "inotify_add_watch")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.descriptor)

    def wait(self, name, times):
        """Returns when a file of this name has been made so many times; false
        if that did not happen in time."""
        end = time.monotonic() + PATIENCE
        while select.select([self.descriptor], [], [], max(0, end - time.monotonic()))[0]:
            data, at = os.read(self.descriptor, 65536), 0
            while at < len(data):
                *_, length = self.HEAD.unpack_from(data, at)
                at += self.HEAD.size + length
                times -= data[at - length:at].rstrip(b"\0") == name.encode()
            if times <= 0:
                return True
        return False


def last_time(output):
    """The last time in statistics.csv; a line may be cut off; 0 without."""
    file = output / "statistics.csv"
    text = file.read_text() if file.exists() else ""
    lines = text[:text.rfind("\n") + 1].splitlines()[1:]
    return float(lines[-1].split(",")[1]) if lines else 0.0


def start(runs, output, keys=(), ranks=1, stderr=subprocess.DEVNULL):
    return subprocess.Popen(
        runs.command(SCENE, *overrides({**FINE, **dict(keys), "Output directory": output}),
                     ranks=ranks),
        env=environment(), stdout=subprocess.DEVNULL, stderr=stderr,
        text=stderr == subprocess.PIPE)


def wait_for_row(process, output, row):
    statistics = output / "statistics.csv"
    deadline = time.monotonic() + PATIENCE
    while not statistics.exists() or statistics.read_bytes().count(b"\n") < row + 2:
        assert process.poll() is None, "ended before its signal"
        assert time.monotonic() < deadline
        time.sleep(0.001)


def interrupt(runs, output, row, delay, keys):
    """Kills a run some time after a row of statistics.csv was written;
    whether that was before the end of the run."""
    process = start(runs, output, keys)
    try:
        wait_for_row(process, output, row)
        time.sleep(delay)
    finally:
        process.kill()
        process.wait()
    return process.returncode != 0


def resume(runs, output, keys=(), ranks=1):
    """Resumes a run, or begins it anew if it has no snapshot, as the
    program asks for."""
    words, option = overrides({**FINE, **dict(keys)}), "--resume"
    if (output / "snapshot.h5").exists():
        with h5py.File(output / "snapshot.h5") as file:
            assert last_time(output) - float(file.attrs["time"]) <= INTERVAL + 1e-9 * STEP
    else:
        refused = runs.execute(SCENE, *words, option, output=output, code=1)
        assert "start the run without --resume" in refused.stderr
        assert last_time(output) < INTERVAL + STEP
        option = "--replace"
    runs.execute(SCENE, *words, option, output=output, ranks=ranks)
    assert list(output.glob("*.tmp")) == []
    return Run(output)


@pytest.fixture(scope="module")
def whole(runs):
    """The run that nothing interrupts."""
    run = runs.run("whole", SCENE, FINE)
    assert len(without_wall_time(run.directory)) == 2 + round(1 / STEP)
    return run


@pytest.fixture(scope="module")
def whole_of_dying(runs):
    run = runs.run("whole-dying", SCENE, {**FINE, **DYING})
    kinds = list(run.events["event"])
    assert min(kinds.count("death"), kinds.count("removal")) > 10
    return run


@pytest.mark.parametrize("keys, fixture", [
    pytest.param({}, "whole", marks=pytest.mark.release), (DYING, "whole_of_dying")])
def test_at_random(runs, request, keys, fixture):
    """Five runs, killed at moments that are drawn, and resumed."""
    uninterrupted, chance, killed = request.getfixturevalue(fixture), random.Random(SEED), 0
    for n in range(5):
        row, delay = chance.randint(0, 29), chance.uniform(0, 0.03)
        print(f"kill -9 {delay * 1e3:.1f} ms after row {row}", flush=True)
        output = runs.work / f"{fixture}-{n}"
        killed += interrupt(runs, output, row, delay, keys)
        assert_same_run(uninterrupted, resume(runs, output, keys))
    # on a machine that stands still in between, a run may be faster
    assert killed >= 3


def test_while_a_snapshot_is_written(runs, whole):
    """snapshot.h5.tmp is there and incomplete or not yet renamed."""
    chance, hit = random.Random(SEED), 0
    # The file is made twice each time: to reserve the space, and to write.
    # A busy machine wakes this process too late for most: then more tries.
    for n, made in enumerate(3 * (2, 4, 7, 14, 12)):
        if n >= 3 and hit >= 2:
            break
        output = runs.work / f"writes-{n}"
        output.mkdir()
        delay = chance.uniform(0, 0.004)
        print(f"kill -9 {delay * 1e3:.1f} ms after {made} times snapshot.h5.tmp", flush=True)
        with NewFiles(output) as files:
            process = start(runs, output)
            try:
                assert files.wait("snapshot.h5.tmp", made)
                time.sleep(delay)
            finally:
                process.kill()
                process.wait()
        hit += (output / "snapshot.h5.tmp").exists()
        assert_same_run(whole, resume(runs, output))
    assert hit >= 2


def test_that_leave_a_semaphore_locked(runs):
    """Open MPI's own way to files has a semaphore of the machine for every
    file name, and a killed run can leave it locked: whoever waits for it
    waits for ever."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.sem_open.restype = ctypes.c_void_p
    name = b"/OMPIO_snapshot.h5.tmp"
    libc.sem_unlink(name)
    assert libc.sem_open(name, os.O_CREAT, 0o600, 0)
    output = runs.work / "semaphore"
    try:
        own = {key: value for key, value in os.environ.items() if "romio" not in key}
        words = runs.command(SCENE, *overrides({"Time/End time": 0.25,
                                                "Output directory": output}))
        subprocess.run(words, env=own, check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL)
    finally:
        libc.sem_unlink(name)
    assert (output / "snapshot.h5").is_file()


# Ctrl-C, and SIGTERM or SIGUSR1 as batch systems send them; mpiexec hands SIGUSR1 on
# to the ranks.
@pytest.mark.parametrize("number, ranks", [
    (signal.SIGINT, 1), (signal.SIGTERM, 1), (signal.SIGHUP, 1), (signal.SIGUSR1, 1),
    pytest.param(signal.SIGUSR1, 2, marks=pytest.mark.release)])
def test_asked_to_end(runs, whole, number, ranks):
    """The run saves its state and ends by the signal, as shells expect; nothing that was
    computed is lost."""
    output = runs.work / f"{number.name}-{ranks}"
    with start(runs, output, ranks=ranks, stderr=subprocess.PIPE) as process:
        wait_for_row(process, output, 11)
        process.send_signal(number)
        said = process.communicate(timeout=PATIENCE)[1]
    with h5py.File(output / "snapshot.h5") as file:
        assert file.attrs["time"] == last_time(output)
    assert "saving the state" in said
    assert f"by {number.name}. The state is saved in snapshot.h5." in said
    assert "--resume' goes on from there" in said
    assert "Stopped at t = " in (output / "log.txt").read_text()
    if ranks == 1:
        assert process.returncode == -number
        assert_same_run(whole, resume(runs, output))
    else:
        assert process.returncode != 0
        resume(runs, output, ranks=ranks)


def test_in_the_middle_of_a_step(runs):
    """A step is not waited for: what its steady fields have changed is undone."""
    keys, chance = {**DYING, "Fields/oxygen/Time": "steady", "Tissue/Cell spacing": 5,
                    "Time/End time": 6 * STEP}, random.Random(SEED)
    del keys["Fields/oxygen/Initial"]
    uninterrupted = runs.run("steady", SCENE, {**FINE, **keys})
    output = runs.work / "steps"
    for row in (0, 2, 4):
        with start(runs, output, keys) as process:
            wait_for_row(process, output, row)
            time.sleep(chance.uniform(0, 0.1))
            process.send_signal(signal.SIGTERM)
        ended = resume(runs, output, keys)
        assert_same_run(uninterrupted, ended)
        shutil.rmtree(output)


@pytest.mark.parametrize("times, name", [(1, "SIGTERM"), (2, "SIGHUP")])
def test_launcher(runs, times, name):
    """mpiexec kills its ranks a second after it has handed SIGTERM on. A second one, as timeout
    sends, ends it at once, and its ranks a second later."""
    output = runs.work / f"launcher-{times}"
    with start(runs, output, ranks=2) as process:
        wait_for_row(process, output, 3)
        for _ in range(times):
            process.send_signal(signal.SIGTERM)
            time.sleep(0.05)
    deadline = time.monotonic() + 10
    while f"by {name}. The state is saved" not in (output / "log.txt").read_text():
        assert time.monotonic() < deadline
        time.sleep(0.01)
    with h5py.File(output / "snapshot.h5") as file:
        assert file.attrs["time"] == last_time(output)


def test_nohup(runs):
    """A hangup that is to be ignored is."""
    words = runs.command(SCENE, *overrides({**FINE, "Output directory": runs.work / "nohup"}))
    with subprocess.Popen(["nohup", *words], env=environment(), stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL) as process:
        wait_for_row(process, runs.work / "nohup", 3)
        process.send_signal(signal.SIGHUP)
    assert process.returncode == 0


def test_asked_twice(runs):
    """The second signal ends the run at once, in the middle of a step."""
    output = runs.work / "twice"
    with start(runs, output, {"Tissue/Cell spacing": 2.5}, stderr=subprocess.PIPE) as process:
        wait_for_row(process, output, 1)
        process.send_signal(signal.SIGTERM)
        heard = b""
        while b"at once" not in heard:
            heard += os.read(process.stderr.fileno(), 4096)
        process.send_signal(signal.SIGTERM)
        assert process.wait(PATIENCE) == -signal.SIGTERM
    assert not (output / "snapshot.h5").exists()
