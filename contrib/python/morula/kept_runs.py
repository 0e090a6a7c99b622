# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of one scene with other keys, each in a directory of its own, where it
is found again: what is there is not run twice."""
import contextlib
import fcntl
import hashlib
import json
import queue
import re
from dataclasses import dataclass
from pathlib import Path

from .command_line import tell
from .execute import Processes
from .record import Record
from .refusal import Refused
from .scene import as_number
from .served import Server

FEW = 3  # runs a process, for which it is not worth its start
N_SNAPSHOTS = 10  # what an interruption may lose is a part of so many
LONGEST_NAME = 255  # of a file; expressions may be longer


@dataclass(frozen=True)
class Job:
    """A scene with overrides; the name is that of its directory. When it has finished, CSV files
    of the points and the snapshot stay if they are in `keep` ('cells', 'surface', 'snapshot')."""

    name: str
    overrides: tuple
    keep: tuple = ("cells", "surface")


def with_snapshots(keys):
    """Overrides for a run with these keys that asks for no snapshots before its end,
    so that it can be resumed; they never change the steps."""
    end = as_number(keys["Time/End time"])
    if as_number(keys["Output/Snapshot interval"]) != 0 or not end:
        return ()
    return (("Output/Snapshot interval", format(end / N_SNAPSHOTS, ".6g")),)


def job_name(special, overrides):
    """Readable by the (key, value) overrides that make a run special, and
    unique for all of them."""
    words = [f"{key.split('/')[-1]}={value}" for key, value in special]
    readable = re.sub(r"[^A-Za-z0-9.,=+-]+", "-", "; ".join(words))[:80]
    unique = hashlib.sha256(repr(overrides).encode()).hexdigest()[:8]
    return f"{readable or 'scene'}.{unique}"


class KeptRuns:
    """Does jobs of a scene below a directory. Runs that were interrupted go on
    from their last snapshot with `resume`, and begin anew without: then their
    times are those of one execution."""

    def __init__(self, scene, directory, ranks=1, n_at_a_time=1, again=False,
                 resume=False, say=print, servers=None, name="morula"):
        self.scene, self.directory = scene, Path(directory)
        self.ranks, self.n_at_a_time = ranks, n_at_a_time
        self.again, self.resume = again, resume
        self.say, self.name = say, name
        self.digest = scene.program.digest
        self._processes, self._lock = Processes(), None
        self._given = servers  # served.Server, or None to start some
        self._servers = queue.LifoQueue()  # those that are idle

    def is_done(self, job):
        """Whether nothing is left to do for a job."""
        record = Record(self.directory / job.name)
        return (not self.again and record.load(self._identity(job))
                and record.cost is not None and not record.killed)

    def check(self, jobs, skip=False):
        """Has the program judge the jobs that are not done. Throws Refused with its message, or
        with `skip` tells it and leaves the job out: the rest is returned."""
        left = [job for job in jobs if not self.is_done(job)]
        refused = set()
        if left:
            tell(f"{self.name}: checking the keys of {len(left)} run{'s' * (len(left) > 1)} ...")
        with self._servers_for(left):
            for job in left:
                try:
                    with self._server() as server:
                        self.scene.program.explain(self.scene.path, job.overrides, server)
                except Refused as refusal:
                    if not skip:
                        raise
                    refused.add(job)
                    self.say(f"{job.name} is left out: {refusal}")
        return [job for job in jobs if job not in refused]

    def run(self, jobs):
        """The records of the jobs, in their order."""
        with self._alone(), self._servers_for(jobs):
            return self._processes.each(lambda pair: self._one(pair[1], f"[{pair[0]}/{len(jobs)}]"),
                                        enumerate(jobs, 1), self.n_at_a_time)

    @contextlib.contextmanager
    def _alone(self):
        """Two programs must not write into the same runs."""
        self.directory.mkdir(parents=True, exist_ok=True)
        with (self.directory / "lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise Refused("--output", self.directory, "a directory that nobody else writes "
                              "into", "Another one, or a run that it has left over, is at work "
                              "there: wait for it, or choose another directory.") from None
            self._lock = lock
            yield
        self._lock = None

    @contextlib.contextmanager
    def _servers_for(self, jobs):
        """Lets runs on one rank be forks, if there are enough of them to be worth
        the start of the processes that fork."""
        n = min(self.n_at_a_time, len(jobs))
        if self.ranks > 1 or self._given is not None or len(jobs) < FEW * n:
            n = 0
        fds = [self._lock.fileno()] if self._lock else []
        own = [Server(self.scene.program.executable, fds) for _ in range(n)]
        for server in own + (self._given or [] if self.ranks == 1 else []):
            self._servers.put(server)
        try:
            yield
        finally:
            self._servers = queue.LifoQueue()
            for server in own:
                server.close()

    @contextlib.contextmanager
    def _server(self):
        """One that is idle, for as long as it is at work; or None."""
        try:
            server = self._servers.get_nowait()
        except queue.Empty:
            yield None
            return
        try:
            yield server
        finally:
            self._servers.put(server)

    def _one(self, job, counter):
        record = Record(self.directory / job.name)
        resumed = self._prepare(job, record)
        if record.finished or record.failed:
            self.say(f"{counter} {job.name}: {record.summary()}, from before")
            return record
        while not self._processes.stopped and record.cost is None:
            self.say(f"{counter} {job.name} "
                     + ("goes on from its snapshot ..." if resumed else "..."))
            self._execute(job, record, resumed)
            if resumed and record.refused:
                record.begin(record.identity, job.overrides)
            resumed = False
        self.say(f"{counter} {job.name}: {record.summary()}")
        return record

    def _prepare(self, job, record):
        """Takes over what is there of a job, or clears its directory; whether
        it is to be resumed."""
        identity = self._identity(job)
        known = not self.again and record.load(identity)
        if known and self.resume and record.resumable:
            record.resume()
            return True
        if not known or record.killed or record.cost is None:
            record.begin(identity, job.overrides)
        return False

    def _execute(self, job, record, resumed):
        overrides = [*job.overrides, ("Output directory", record.output)]
        words = self.scene.program.command(self.scene.path, overrides, self.ranks)
        # The directory is this object's own.
        words += ["--resume" if resumed else "--replace"]
        cost = record.directory / "cost.json"
        with self._server() as server:
            ended = self._processes.call(
                words, cost=cost, stdout=record.directory / "stdout",
                stderr=record.directory / "stderr", server=server,
                # a run that outlives this process keeps the directory locked
                pass_fds=[self._lock.fileno()])
        if ended is None:
            return
        if not cost.is_file():
            raise RuntimeError(f"the run {job.name} was ended from outside "
                               "together with what measured it")
        if self.scene.program.digest != self.digest:
            raise Refused("--morula", self.scene.program.executable, "an executable that nobody "
                          "replaces while runs go on", "The same command begins anew with the new "
                          "one.")
        record.add({**json.loads(cost.read_text()), "resumed": resumed},
                   self.ranks, self.n_at_a_time, job.keep)

    def _identity(self, job):
        """What a run depends on: the program, every key, the files that keys
        name, the ranks, and what is kept of it."""
        keys = {**self.scene.keys, **dict(job.overrides)}
        keys.pop("Output directory", None)
        # as the program does: here, or beside the scene
        places = {value: next((path for path in (Path(value), self.scene.path.parent / value)
                               if value and len(value) < LONGEST_NAME and path.is_file()), None)
                  for value in keys.values()}
        files = {value: hashlib.sha256(path.read_bytes()).hexdigest()
                 for value, path in places.items() if path}
        text = json.dumps([self.digest, keys, files, self.ranks, sorted(job.keep)], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()
