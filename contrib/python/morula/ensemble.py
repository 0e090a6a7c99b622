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

LAUNCHER = Path(__file__).with_name("measure.py")


@dataclass(frozen=True)
class Run:
    """A scene with overrides; the name is that of its directory. When it has
    finished, CSV files of the points and the snapshot stay if they are in
    `keep` ('cells', 'surface', 'snapshot')."""

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
    """Does runs of a scene below a directory, each in a room of its own. Runs
    that were interrupted go on from their last snapshot with `resume`, and
    begin anew without: then their wall times are those of one execution."""

    def __init__(self, scene, directory, ranks=1, jobs=1, repeats=1,
                 again=False, resume=False, say=print):
        self.scene, self.directory = scene, Path(directory)
        self.ranks, self.jobs, self.repeats = ranks, jobs, repeats
        self.again, self.resume, self.say = again, resume, say
        self.digest = scene.program.digest
        self._children, self._guard = set(), threading.Lock()
        self._stopped, self._lock = False, None

    def is_done(self, run):
        """Whether nothing is left to do for a run."""
        record = Record(self.directory / run.name)
        return (not self.again and record.load(self._identity(run))
                and bool(record.repeats) and not record.killed)

    def check(self, runs):
        """Has the program judge the runs that are not done; throws Refused
        with its message."""
        for run in runs:
            if not self.is_done(run):
                self.scene.program.explain(self.scene.path, run.overrides)

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
                              "nobody else writes into", "Another one, or a "
                              "run that it has left over, is at work there: "
                              "wait for it, or choose another "
                              "directory.") from None
            self._lock = lock
            yield

    def _one(self, run, counter):
        record = Record(self.directory / run.name)
        resumed = self._prepare(run, record)
        done = len(record.repeats)
        if record.finished and done >= self.repeats or record.failed:
            self.say(f"{counter} {run.name}: {record.summary()}, from before")
            return record
        while not self._stopped and len(record.repeats) < self.repeats:
            self.say(f"{counter} {run.name} "
                     + ("goes on from its snapshot ..." if resumed else "..."))
            self._launch(run, record, resumed)
            if resumed and record.refused:
                record.begin(record.identity, run.overrides)
            elif record.failed:
                break
            resumed = False
        self.say(f"{counter} {run.name}: {record.summary()}")
        return record

    def _prepare(self, run, record):
        """Takes over what is there of a run, or clears its directory; whether
        it is to be resumed."""
        identity = self._identity(run)
        known = not self.again and record.load(identity)
        if known and self.resume and record.resumable:
            record.resume()
            return True
        if not known or record.killed or not record.repeats:
            record.begin(identity, run.overrides)
        return False

    def _launch(self, run, record, resumed):
        overrides = [*run.overrides, ("Output directory", record.output)]
        words = self.scene.program.command(self.scene.path, overrides,
                                           self.ranks)
        # The directory is this object's own.
        words += ["--resume" if resumed else "--replace"]
        cost = record.directory / "cost.json"
        cost.unlink(missing_ok=True)
        with self._guard:
            if self._stopped:
                return
            child = subprocess.Popen(
                [sys.executable, "-I", "-S", LAUNCHER, cost,
                 record.directory / "stdout", record.directory / "stderr",
                 *words], env=environment(), start_new_session=True,
                # a run that outlives this process keeps the directory locked
                pass_fds=[self._lock.fileno()])
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
            record.add({**json.loads(cost.read_text()), "resumed": resumed},
                       self.ranks, self.jobs, run.keep)

    def _stop(self, futures):
        """Ends what this object has started, and nothing else."""
        for future in futures:
            future.cancel()
        with self._guard:
            self._stopped = True
            children = list(self._children)
        for number, patience in ((signal.SIGTERM, 60.0), (signal.SIGKILL, 1.0)):
            # They save their state after the step that they are at.
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

