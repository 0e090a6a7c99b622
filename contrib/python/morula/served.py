# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A process of the program that does runs in forks of itself: `morula --serve`.

A start of the program takes half a second, most of it the linking of two hundred libraries; a fork
has them already."""
import os
import subprocess
import tempfile
import threading
from pathlib import Path

from .execute import Ended, start

# Symbols are found once, before the forks.
AT_ONCE = {"LD_BIND_NOW": "1"}


class _Fork:
    """A run that is at work, for execute.end."""

    def __init__(self, pid):
        self.pid, self.ended = pid, False

    def poll(self):
        return 0 if self.ended else None


class Server:
    """Does runs on one rank, one at a time; any thread may ask. Its runs inherit
    the descriptors pass_fds. To be closed."""

    def __init__(self, executable, pass_fds=()):
        self._process = start([executable, "--serve"], stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, env=AT_ONCE, pass_fds=pass_fds)
        self._guard = threading.Lock()

    def close(self):
        """Ends the process; a run that is at work goes on to its end."""
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()

    def call(self, words, *, cwd=None, stdout=None, stderr=None, cost=None, begun=lambda run: None):
        """Runs a command line (its first word is the program's name) and returns
        execute.Ended. stdout, stderr: files; without them what it said is
        returned. cost: file for what it cost. `begun` is told of the fork."""
        with self._guard, tempfile.TemporaryDirectory() as scratch:
            files = [Path(stdout or f"{scratch}/out"), Path(stderr or f"{scratch}/err")]
            for file in files:
                file.write_bytes(b"")
            places = [cwd or os.getcwd(), *files, cost or ""]
            request = [os.path.abspath(place) if place else ""
                       for place in places] + list(words[1:])
            self._process.stdin.write(b"".join(os.fsencode(str(word)) + b"\0" for word
                                               in [len(request), *request]))
            self._process.stdin.flush()
            first = self._process.stdout.readline()
            if not first:
                raise RuntimeError("the program that does the runs has ended")
            run = _Fork(int(first))
            begun(run)
            last = self._process.stdout.readline()
            run.ended = True
            if not last:
                raise RuntimeError("the program that does the runs has ended")
            return Ended(int(last.split()[0]), *(
                "" if kept else file.read_text(encoding="utf-8",
                                               errors="replace")
                for file, kept in zip(files, (stdout, stderr))))
