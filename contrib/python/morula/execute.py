# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How the program is started, by every tool and by every test.

`command` makes the words of a run, `call` runs them to their end, `Processes` does that for
several at a time and ends what is left when one of them, or the user, gives up. Runs watch a pipe
that only this process can write to: however it ends, they save their state and end, too."""
import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

# One thread a rank, any number of ranks, by any user, not bound to the same
# core by runs that do not know of each other. MPI's search for graphics cards
# would connect to every X server, and end the run if that server goes away
# meanwhile. CMake reads the file, too, for the tests.
ENVIRONMENT = dict(line.split("=", 1) for line in Path(__file__).with_name(
    "mpi.env").read_text(encoding="utf-8").split())

MEASURE = Path(__file__).with_name("measure.py")
PATIENCE = 60.0  # s, for the step that a run is at: then it saves its state


LIFELINE = list(os.pipe())  # runs watch the first end; only this process has the other one open


def _own_lifeline():
    """A fork must not keep the runs of its parent alive."""
    for descriptor in LIFELINE:
        os.close(descriptor)
    LIFELINE[:] = os.pipe()


os.register_at_fork(after_in_child=_own_lifeline)


def environment():
    """That of all processes started here."""
    return {**os.environ, **ENVIRONMENT,
            "MORULA_LIFELINE": f"{LIFELINE[0]}:{os.fstat(LIFELINE[0]).st_ino}"}


def start(words, *, env=(), pass_fds=(), **options):
    """A process in a session of its own; `env` has variables besides."""
    return subprocess.Popen([str(word) for word in words], start_new_session=True,
                            env={**environment(), **dict(env)},
                            pass_fds=[*pass_fds, LIFELINE[0]], **options)


def cores():
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0))


def overrides(keys):
    """The words -s KEY=VALUE, of a dictionary or of pairs."""
    pairs = keys.items() if isinstance(keys, dict) else keys
    return [word for key, value in pairs for word in ("-s", f"{key}={value}")]


def command(program, *words, ranks=1, mpiexec="mpiexec"):
    """The words that run a program with these words, on so many ranks."""
    start = [mpiexec, "-n", ranks] if ranks > 1 else []
    return [str(word) for word in (*start, program, *words)]


@dataclass(frozen=True)
class Ended:
    """A process that has ended, its exit code (negative: of a signal), and what
    it said, empty if that went to a file."""

    code: int
    stdout: str
    stderr: str

    @property
    def text(self):
        """Both together; all in order where stderr=subprocess.STDOUT."""
        return self.stdout + self.stderr


class Processes:
    """Runs commands, each in a group of processes of its own, which ends as a whole."""

    def __init__(self):
        self.stopped = False
        self._running, self._guard = set(), threading.Lock()

    def call(self, words, *, cwd=None, timeout=None, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
             env=(), cost=None, pass_fds=(), server=None):
        """Runs a command to its end; None after stop(). stdout and stderr are what subprocess
        takes, or the paths of files; `env` has variables besides, `cost` is the file for what
        measure.py says of it. A served.Server does it in a fork, with stdout and stderr in files.
        If this thread is interrupted, or the timeout (s) is over, the command is ended first; the
        latter throws subprocess.TimeoutExpired."""
        if server:
            return self._serve(server, words, cwd=cwd, stdout=stdout, stderr=stderr, cost=cost)
        with contextlib.ExitStack() as files:
            streams = {name: files.enter_context(open(to, "wb"))
                       if isinstance(to, (str, os.PathLike)) else to
                       for name, to in (("stdout", stdout),
                                        ("stderr", stderr))}
            if cost:
                Path(cost).unlink(missing_ok=True)
                words = [sys.executable, "-I", "-S", str(MEASURE), str(cost), *words]
            with self._guard:
                if self.stopped:
                    return None
                child = start(words, cwd=cwd, text=True, errors="replace", env=env,
                              stdin=subprocess.DEVNULL, pass_fds=pass_fds, **streams)
                self._running.add(child)
            try:
                out, err = child.communicate(timeout=timeout)
            except BaseException as reason:
                late = isinstance(reason, subprocess.TimeoutExpired)
                end([child], 0 if late else PATIENCE)
                child.communicate()
                raise
            finally:
                with self._guard:
                    self._running.discard(child)
            return None if self.stopped else Ended(child.returncode, out or "", err or "")

    def _serve(self, server, words, cost, **files):
        if cost:
            Path(cost).unlink(missing_ok=True)
        runs = []

        def begun(run):
            with self._guard:
                runs.append(run)
                self._running.add(run)
                late = self.stopped
            if late:
                end([run], PATIENCE)

        if self.stopped:
            return None
        try:
            ended = server.call(words, cost=cost, begun=begun, **files)
        finally:
            with self._guard:
                self._running.difference_update(runs)
        return None if self.stopped else ended

    def each(self, function, items, jobs):
        """function(item) of all items, so many at a time, in their order. If
        one throws, or the user interrupts, all that call() has begun ends."""
        with ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(function, item) for item in items]
            try:
                return [future.result() for future in futures]
            except BaseException:
                for future in futures:
                    future.cancel()
                self.stop()
                raise

    def stop(self):
        """Ends what has been started, and nothing else; starts nothing more."""
        with self._guard:
            self.stopped = True
            children = list(self._running)
        end(children, PATIENCE)


def call(words, **options):
    """Runs a command to its end; see Processes.call."""
    return Processes().call(words, **options)


def end(children, patience):
    """Asks the groups of processes to end, and kills them after so many seconds. mpiexec hands
    SIGUSR1 on; after SIGTERM it would kill the ranks before they have saved their state."""
    launchers = [child for child in children if any(
        Path(word).name in ("mpiexec", "mpirun") for word in getattr(child, "args", ()))]
    for number, asked, wait in ((signal.SIGUSR1, launchers, patience),
                                (signal.SIGTERM, children, patience),
                                (signal.SIGKILL, children, 1.0)):
        asked = [child for child in asked if _signalled(child, number)]
        until = time.monotonic() + wait
        while time.monotonic() < until and any(_signalled(child, 0) for child in asked):
            time.sleep(0.05)


def _signalled(child, number):
    """Sends a signal to the group that a process has begun, which may outlive
    it; whether anybody of it was there. 0 only asks."""
    child.poll()
    try:
        os.killpg(child.pid, number)
    except ProcessLookupError:
        return False
    return True
