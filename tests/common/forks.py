# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program on one rank that cost a fork instead of a start."""
import atexit
import functools
import os
import subprocess
import tempfile
import threading
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

    def call(self, words, cwd, timeout):
        with tempfile.TemporaryDirectory() as scratch:
            out, err = (Path(scratch) / name for name in ("out", "err"))
            request = [cwd or os.getcwd(), out, err, *words]
            self.process.stdin.write(b"".join(
                os.fsencode(str(word)) + b"\0"
                for word in [len(request), *request]))
            self.process.stdin.flush()
            child = int(self.process.stdout.readline())
            timer = threading.Timer(timeout or 0, os.kill, (child, SIGKILL))
            if timeout:
                timer.start()
            code = int(self.process.stdout.readline())
            timer.cancel()
            if timeout and code == -SIGKILL:
                raise subprocess.TimeoutExpired(words, timeout)
            return Ended(code, *(file.read_text(encoding="utf-8",
                                                errors="replace")
                                 for file in (out, err)))


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


def call(words, *, cwd=None, timeout=None):
    """morula.execute.call; the program itself, on one rank, is a fork, and so is
    a tool of contrib/, with what it asks of the program."""
    words = [str(word) for word in words]
    forks, tool = None, forked_tools.tool_of(words[0])
    if tool:
        if "--morula" in words[:-1]:
            # Before the tool forks, which cannot end it.
            forks_of(os.path.abspath(words[words.index("--morula") + 1]))
        return forked_tools.call(tool, words[1:], cwd=cwd, timeout=timeout,
                                 runs=call)
    if os.path.basename(words[0]) == "morula":
        forks = forks_of(os.path.abspath(words[0]))
    if forks:
        return forks.call(words, cwd, timeout)
    return start(words, cwd=cwd, timeout=timeout)
