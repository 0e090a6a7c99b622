# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program on one rank, and tools of contrib/, that cost a fork instead
of a start: what a fork has imported and linked already takes a second."""
import atexit
import functools
import importlib
import multiprocessing
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from signal import SIGKILL

from morula import execute
from morula.__main__ import TOOLS, main
from morula.served import Server

CONTRIB = Path(__file__).resolve().parents[2] / "contrib"
QUESTIONS = ("--parameters", "--parameters=json", "--version")


@functools.lru_cache(maxsize=None)
def server_of(morula):
    """The process of an executable that does its runs."""
    server = Server(morula)
    atexit.register(server.close)
    return server


def call(words, *, cwd=None, timeout=None, **options):
    """morula.execute.call; the program itself, on one rank, is a fork, and so is
    a tool of contrib/, with what it asks of the program."""
    words = [str(word) for word in words]
    if is_tool(Path(words[0])):
        if "--morula" in words[:-1]:
            # The server must be there before the fork, which cannot end it.
            fork([words[words.index("--morula") + 1], "--version"])
        return call_tool(words, cwd, timeout)
    return (fork(words, cwd=cwd, timeout=timeout, **options)
            or execute.call(words, cwd=cwd, timeout=timeout, **options))


def is_tool(path):
    """Whether a path in contrib/ starts a tool; copies do not."""
    return (path.parent in (CONTRIB, CONTRIB / "upkeep") and path.name in TOOLS
            and path.read_text().endswith(
                f'/python/launch" -P -m morula {path.name} "$@"\n'))


def is_program(morula):
    """Whether this is the program itself where it was built: no script in its
    place, and no copy, which a test may want to change."""
    if (morula.name != "morula" or not morula.is_file()
            or not (morula.parent / "tests").is_dir()):
        return False
    with morula.open("rb") as file:
        return file.read(4) == b"\x7fELF"


def call_tool(words, cwd, timeout):
    """Runs a tool to its end in a fork."""
    tool = Path(words[0]).name
    importlib.import_module(TOOLS[tool])
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        def become():
            sys.stdout, sys.stderr = out, err
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            os.chdir(cwd or ".")
            # what contrib/python/launch sets, for processes that the tool starts
            os.environ.update(execute.ENVIRONMENT, PYTHONPATH=os.pathsep.join(
                map(str, (CONTRIB / "python", CONTRIB.parent))))
            execute.Processes.call = forked(execute.Processes.call)
            sys.argv = ["morula", tool, *words[1:]]
            sys.exit(main())

        child = multiprocessing.get_context("fork").Process(target=become)
        child.start()
        child.join(timeout)
        child.kill()
        child.join()
        for file in (out, err):
            file.seek(0)
        return execute.Ended(child.exitcode, out.read(), err.read())


def forked(start):
    """Processes.call that does what it can by forks, the rest by start()."""
    guard = threading.Lock()

    def call_or_start(self, words, **options):
        with guard:
            ended = fork([str(word) for word in words], **options)
        return ended or start(self, words, **options)
    return call_or_start


def fork(words, *, cwd=None, timeout=None, pass_fds=(), server=None, **files):
    """A run on one rank by a fork; None for another command. `files` are stdout,
    stderr and cost; the file descriptors are not passed."""
    morula = Path(words[0]).absolute()
    if not is_program(morula) or subprocess.STDOUT in files.values():
        return None
    if tuple(words[1:]) in ((question,) for question in QUESTIONS) and not files:
        return said(morula, words[1])
    timers = []

    def begun(run):
        timers.append(threading.Timer(timeout, os.killpg, (run.pid, SIGKILL)))
        timers[0].start()

    ended = server_of(morula).call(words, cwd=cwd, **files,
                                   **({"begun": begun} if timeout else {}))
    if timeout and timers[0].finished.is_set():
        raise subprocess.TimeoutExpired(words, timeout)
    for timer in timers:
        timer.cancel()
    return ended


@functools.lru_cache(maxsize=None)
def said(morula, question):
    """What the program says of itself, which is always the same."""
    return server_of(morula).call([morula, question])
