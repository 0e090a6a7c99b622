# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command line of programs that do many runs of a scene."""
import argparse
import contextlib
import math
import signal
import sys
from pathlib import Path

from .places import MORULA
from .refusal import Refused


class Parser(argparse.ArgumentParser):
    """Mistakes in the words themselves end like all others."""

    def error(self, message):
        raise Refused("The command line", " ".join(sys.argv[1:]),
                      "what --help shows", message + ".")


def add_run_options(add, directory):
    """The options that say how and where the runs are done; `add` is
    Parser.add_argument, `directory` the default of --output in words."""
    add("-s", "--set", action="append", default=[], metavar="KEY=VALUE",
        help="overrides a key of the scene for all runs")
    add("--ranks", default="1", help="MPI ranks of each run")
    add("--jobs", default="1", help="runs at the same time; more than one "
        "makes their times less certain")
    add("--again", action="store_true", help="do not use runs from before")
    add("--plan", action="store_true", help="check, list the runs, and stop")
    add("--output", type=Path, metavar="DIRECTORY",
        help=f"default: {directory}, in the working directory")
    add("--morula", default=MORULA, help="the executable")
    add("--mpiexec", default="mpiexec")


def tell(text):
    """A word of progress, beside the results on standard output."""
    print(text, file=sys.stderr, flush=True)


def whole_number(option, text):
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise Refused(option, text, "an integer >= 1")
    return number


def lengths(option, text, numbers):
    """A number in um, or several with commas, so many as one of `numbers`."""
    try:
        found = [float(word) for word in (text or "").split(",")]
    except ValueError:
        found = []
    if len(found) not in numbers or not all(0 < x < math.inf for x in found):
        raise Refused(option, text or "", " or ".join(map(str, numbers))
                      + " numbers > 0 in um, in the order x,y,z")
    return found


def ranks_and_jobs(options):
    """Both as numbers."""
    return whole_number("--ranks", options.ranks), whole_number("--jobs", options.jobs)


def output_directory(options, default):
    """--output, or the default; not a file."""
    directory = options.output or default
    if directory.exists() and not directory.is_dir():
        raise Refused("--output", directory, "a directory")
    return directory


@contextlib.contextmanager
def like_ctrl_c():
    """Asked to end from outside is like Ctrl-C, so that no run is left over."""
    def stop(*_):
        raise KeyboardInterrupt

    before = {number: signal.signal(number, stop)
              for number in (signal.SIGTERM, signal.SIGHUP)
              if signal.getsignal(number) != signal.SIG_IGN}  # as by nohup
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run_tool(name, tool, stopped="the same command goes on with what is missing"):
    """What tool() returns as the exit code; 1 for what makes no sense, 130 if it was stopped,
    with a word on what that means."""
    try:
        with like_ctrl_c():
            return tool()
    except (Refused, OSError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(f"{name}: stopped; {stopped}.", file=sys.stderr)
        return 130
