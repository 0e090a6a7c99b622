# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program on one rank that cost a fork instead of a start."""
import atexit
import contextlib
import functools
import os
import subprocess
import threading
from signal import SIGKILL

from morula.execute import call as start
from morula.served import Server

from tests.common import forked_tools

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
    tool = forked_tools.tool_of(words[0])
    if tool:
        if "--morula" in words[:-1]:
            # Before the tool forks, which cannot end it.
            morula = os.path.abspath(words[words.index("--morula") + 1])
            if is_program(morula):
                for question in QUESTIONS:
                    said(morula, question)
        return forked_tools.call(tool, words[1:], cwd=cwd, timeout=timeout,
                                 runs=fork)
    return (fork(words, cwd=cwd, timeout=timeout, **options)
            or start(words, cwd=cwd, timeout=timeout, **options))


def is_program(morula):
    """Whether this is the program itself where it was built: no script in its
    place, and no copy, which a test may want to change."""
    tests = os.path.join(os.path.dirname(morula), "tests")
    if (os.path.basename(morula) != "morula" or not os.path.isfile(morula)
            or not os.path.isdir(tests)):
        return False
    with open(morula, "rb") as file:
        return file.read(4) == b"\x7fELF"


def fork(words, *, cwd=None, timeout=None, pass_fds=(), server=None, **files):
    """The same by a fork; None for another command. `files` are stdout, stderr
    and cost; the file descriptors are not passed."""
    morula = os.path.abspath(words[0])
    if not is_program(morula) or subprocess.STDOUT in files.values():
        return None
    if len(words) == 2 and words[1] in QUESTIONS and not files:
        return said(morula, words[1])
    late = []

    def kill(run):
        late.append(run)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(run.pid, SIGKILL)

    timers = []

    def begun(run):
        if timeout:
            timers.append(threading.Timer(timeout, kill, [run]))
            timers[0].start()

    ended = server_of(morula).call(words, cwd=cwd, begun=begun, **files)
    for timer in timers:
        timer.cancel()
    if late:
        raise subprocess.TimeoutExpired(words, timeout)
    return ended


@functools.lru_cache(maxsize=None)
def said(morula, question):
    """What the program says of itself, which is always the same."""
    return server_of(morula).call([morula, question])
