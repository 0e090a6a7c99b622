# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tools of contrib/ that cost a fork of the test instead of a start of Python:
the fork has the tool's libraries already, whose import takes a second or two."""
import importlib
import os
import signal
import sys
import tempfile
import threading
from pathlib import Path

from morula import execute
from morula.__main__ import TOOLS, main

CONTRIB = Path(__file__).resolve().parents[2] / "contrib"
FOLDERS = (CONTRIB, CONTRIB / "upkeep")


def tool_of(program):
    """The name of the tool that a path in contrib/ starts; None if it is another
    program, or a copy of one."""
    path = Path(program)
    if path.parent not in FOLDERS or path.name not in TOOLS:
        return None
    start = f'/python/launch" -P -m morula {path.name} "$@"\n'
    return path.name if path.read_text().endswith(start) else None


def call(tool, words, *, cwd=None, timeout=None, runs=None):
    """Runs a tool to its end in a fork, and returns what execute.call returns.

    `runs` does what the tool asks of execute.call, or returns None if it
    cannot."""
    importlib.import_module(TOOLS[tool])
    with tempfile.TemporaryDirectory() as scratch:
        out, err = (Path(scratch) / name for name in ("out", "err"))
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            _become(tool, words, cwd, (out, err), runs)
        timer = threading.Timer(timeout or 0, os.kill,
                                (child, signal.SIGKILL))
        if timeout:
            timer.start()
        _, status = os.waitpid(child, 0)
        timer.cancel()
        return execute.Ended(os.waitstatus_to_exitcode(status),
                             *(file.read_text(errors="replace")
                               for file in (out, err)))


def _become(tool, words, cwd, files, runs):
    """Is the tool from here on, and never returns."""
    code = 1
    try:
        for descriptor, path in enumerate((os.devnull, *files)):
            flags = os.O_WRONLY | os.O_CREAT if descriptor else os.O_RDONLY
            file = os.open(path, flags, 0o644)
            os.dup2(file, descriptor)
            os.close(file)
        # pytest has streams of its own in the place of these
        sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
        os.chdir(cwd or os.getcwd())
        os.environ.update(execute.ENVIRONMENT)
        if runs:
            _let(runs, execute.Processes)
        sys.argv = ["morula", tool, *words]
        sys.exit(main())
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        code = end.code if isinstance(end.code, int) else int(bool(end.code))
    except BaseException:  # as Python ends without a fork
        sys.excepthook(*sys.exc_info())
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _let(runs, processes):
    """Lets `runs` do what it can of what processes.call() is asked for."""
    start, one_at_a_time = processes.call, threading.Lock()

    def call_or_start(self, words, **options):
        with one_at_a_time:
            ended = runs(words, **options)
        return ended or start(self, words, **options)

    processes.call = call_or_start
