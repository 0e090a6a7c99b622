# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs what is not there yet, and keeps what it cost."""
import concurrent.futures
import contextlib
import fcntl
import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from .program import environment
from .record import Record
from .refusal import Refused

LAUNCHER = Path(__file__).with_name("launcher.py")


@dataclass(frozen=True)
class Run:
    """A scene with overrides; the name is that of its directory. Of the files
    of points, those of the kinds in `keep` stay ('cells', 'surface')."""

    name: str
    overrides: tuple
    keep: tuple = ("cells", "surface")


def run_name(special, overrides):
    """Readable by the (key, value) overrides that make a run special, and
    unique for all of them."""
    words = [f"{key.split('/')[-1]}={value}" for key, value in special]
    readable = re.sub(r"[^A-Za-z0-9.,=+-]+", "-", "; ".join(words))[:80]
    unique = hashlib.sha256(repr(overrides).encode()).hexdigest()[:8]
    return f"{readable or 'scene'}.{unique}"


def signalled(child, number):
    """Sends a signal to the group that a process has begun, which may outlive
    it; whether anybody of it was there. 0 only asks."""
    child.poll()
    try:
        os.killpg(child.pid, number)
    except ProcessLookupError:
        return False
    return True


class Runner:
    """Does runs of a scene below a directory, each in a room of its own."""

    def __init__(self, scene, directory, ranks=1, jobs=1, repeats=1,
                 again=False, say=print):
        self.scene, self.directory = scene, Path(directory)
        self.ranks, self.jobs, self.repeats = ranks, jobs, repeats
        self.again, self.say = again, say
        self.digest = scene.program.digest
        self._children, self._guard = set(), threading.Lock()
        self._stopped = False

    def is_done(self, run):
        """Whether nothing is left to do for a run."""
        record = Record(self.directory / run.name)
        return (not self.again and record.load(self._identity(run))
                and not record.killed)

    def run(self, runs):
        """The records of the runs, in their order."""
        with self._alone(), concurrent.futures.ThreadPoolExecutor(
                self.jobs) as pool:
            futures = [pool.submit(self._one, run, f"[{i}/{len(runs)}]")
                       for i, run in enumerate(runs, 1)]
            try:
                return [future.result() for future in futures]
            except BaseException:
                self._stop(futures)
                raise

    @contextlib.contextmanager
    def _alone(self):
        """Two programs must not write into the same runs."""
        self.directory.mkdir(parents=True, exist_ok=True)
        with (self.directory / "lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise Refused("--output", self.directory, "a directory that "
                              "nobody else writes into", "Another one is at "
                              "work there: wait for it, or choose another "
                              "directory.") from None
            yield

    def _one(self, run, counter):
        record = Record(self.directory / run.name)
        identity = self._identity(run)
        if self.again or not record.load(identity) or record.killed:
            record.begin(identity, run.overrides)
        done = len(record.repeats)
        if record.finished and done >= self.repeats or record.failed:
            self.say(f"{counter} {run.name}: {record.summary()}, from before")
            return record
        while not self._stopped and len(record.repeats) < self.repeats:
            self.say(f"{counter} {run.name} ...")
            self._launch(run, record)
            if record.failed:
                break
        self.say(f"{counter} {run.name}: {record.summary()}")
        return record

    def _launch(self, run, record):
        overrides = [*run.overrides, ("Output directory", record.output)]
        words = self.scene.program.command(self.scene.path, overrides,
                                           self.ranks)
        cost = record.directory / "cost.json"
        cost.unlink(missing_ok=True)
        with self._guard:
            if self._stopped:
                return
            child = subprocess.Popen(
                [sys.executable, "-I", "-S", LAUNCHER, cost,
                 record.directory / "stdout", record.directory / "stderr",
                 *words], env=environment(), start_new_session=True)
            self._children.add(child)
        child.wait()
        with self._guard:
            self._children.discard(child)
        if not self._stopped:
            if not cost.is_file():
                raise RuntimeError(f"the run {run.name} was ended from outside "
                                   "together with its launcher")
            if self.scene.program.digest != self.digest:
                raise Refused("--morula", self.scene.program.executable,
                              "an executable that nobody replaces while runs "
                              "go on", "The same command begins anew with the "
                              "new one.")
            record.add(json.loads(cost.read_text()), self.ranks, self.jobs,
                       run.keep)

    def _stop(self, futures):
        """Ends what this object has started, and nothing else."""
        for future in futures:
            future.cancel()
        with self._guard:
            self._stopped = True
            children = list(self._children)
        for number, patience in ((signal.SIGTERM, 5.0), (signal.SIGKILL, 1.0)):
            # mpiexec hands the signal on to the ranks
            children = [child for child in children if signalled(child, number)]
            end = time.monotonic() + patience
            while time.monotonic() < end and any(signalled(child, 0)
                                                 for child in children):
                time.sleep(0.05)

    def _identity(self, run):
        """What a run depends on: the program, every key, the files that keys
        name, the ranks, and what is kept of it."""
        keys = {**self.scene.keys, **dict(run.overrides)}
        keys.pop("Output directory", None)
        files = {value: hashlib.sha256(Path(value).read_bytes()).hexdigest()
                 for value in keys.values() if value and Path(value).is_file()}
        text = json.dumps([self.digest, keys, files, self.ranks,
                           sorted(run.keep)], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

