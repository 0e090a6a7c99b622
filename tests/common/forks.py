# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program on one rank that cost a fork instead of a start."""
import atexit
import functools
import json
import os
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from signal import SIGKILL

from morula.execute import Ended, environment
from morula.execute import call as start

from tests.common import forked_tools

# Symbols are found once, before the forks, and Open MPI opens only what a rank
# alone needs: a fork takes 0.10 s with them and 0.13 s without.
ALONE = {"LD_BIND_NOW": "1", "HWLOC_COMPONENTS": "-pci", "OMPI_MCA_btl": "self",
         "OMPI_MCA_coll": "basic,self,libnbc", "OMPI_MCA_osc": "rdma",
         "OMPI_MCA_shmem": "mmap", "OMPI_MCA_state": "novm,app",
         "OMPI_MCA_errmgr": "default_app", "OMPI_MCA_reachable": "weighted"}

QUESTIONS = ("--parameters", "--version")


class Forks:
    """A process of build/tests/forks, which forks for every run."""

    def __init__(self, executable):
        self.process = subprocess.Popen(
            [executable], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            env={**environment(), **ALONE})
        atexit.register(self.end)

    def end(self):
        self.process.stdin.close()
        self.process.wait()

    def call(self, words, cwd, timeout, stdout=None, stderr=None, cost=None):
        with tempfile.TemporaryDirectory() as scratch:
            out, err = stdout or f"{scratch}/out", stderr or f"{scratch}/err"
            for file in filter(None, (out, err, cost)):
                Path(file).unlink(missing_ok=True)
            begin = time.monotonic()
            request = [cwd or os.getcwd(), out, err, *words]
            self.process.stdin.write(b"".join(
                os.fsencode(str(word)) + b"\0"
                for word in [len(request), *request]))
            self.process.stdin.flush()
            child = int(self.process.stdout.readline())
            timer = threading.Timer(timeout or 0, os.kill, (child, SIGKILL))
            if timeout:
                timer.start()
            code, peak = map(int, self.process.stdout.readline().split())
            timer.cancel()
            if timeout and code == -SIGKILL:
                raise subprocess.TimeoutExpired(words, timeout)
            if cost:
                Path(cost).write_text(json.dumps(
                    {"exit": code, "peak_bytes": 1024 * peak,
                     "process_seconds": time.monotonic() - begin}))
            return Ended(code, *("" if kept else Path(file).read_text(
                encoding="utf-8", errors="replace")
                for file, kept in ((out, stdout), (err, stderr))))


@functools.lru_cache(maxsize=None)
def forks_of(morula):
    """The Forks of an executable; None if its build has none that is as new."""
    forks = Path(morula).parent / "tests/forks"
    library = Path(morula).parent / "libmorula.a"
    if not forks.is_file() or not library.is_file():
        return None
    if min(forks.stat().st_mtime, os.stat(morula).st_mtime) < \
            library.stat().st_mtime:
        return None
    return Forks(forks)


def call(words, *, cwd=None, timeout=None, **options):
    """morula.execute.call; the program itself, on one rank, is a fork, and so is
    a tool of contrib/, with what it asks of the program."""
    words = [str(word) for word in words]
    tool = forked_tools.tool_of(words[0])
    if tool:
        if "--morula" in words[:-1]:
            # Before the tool forks, which cannot end it.
            morula = os.path.abspath(words[words.index("--morula") + 1])
            if forks_of(morula):
                for question in QUESTIONS:
                    said(morula, question)
        return forked_tools.call(tool, words[1:], cwd=cwd, timeout=timeout,
                                 runs=fork)
    return (fork(words, cwd=cwd, timeout=timeout, **options)
            or start(words, cwd=cwd, timeout=timeout, **options))


def fork(words, *, cwd=None, timeout=None, pass_fds=(), **files):
    """The same by a fork; None if there are none for this command. `files` are
    stdout, stderr and cost; the file descriptors are not passed."""
    morula = os.path.abspath(words[0])
    if (os.path.basename(morula) != "morula" or not forks_of(morula)
            or subprocess.STDOUT in files.values()):
        return None
    if len(words) == 2 and words[1] in QUESTIONS and not files:
        return said(morula, words[1])
    return forks_of(morula).call(words, cwd, timeout, **files)


@functools.lru_cache(maxsize=None)
def said(morula, question):
    """What the program says of itself, which is always the same."""
    return forks_of(morula).call([morula, question], None, None)
