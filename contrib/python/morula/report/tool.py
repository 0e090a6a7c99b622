# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command morula report."""
import argparse
import sys
from pathlib import Path

from morula.command_line import run_tool
from morula.files import write
from morula.places import MORULA
from morula.program import Program
from morula.refusal import Refused
from morula.run import Run

from .cells import fields_of
from .document import page

DESCRIPTION = """Makes one HTML page about a run.

    morula report output/bud                  writes output/bud/report.html
    morula report output/bud --states 5 --fields energy_density,phase

The page holds everything, the cells in 3-D too, opens from the disk and needs
no network. doc/looking-at-results.md shows one.
"""


def arguments(words):
    parser = argparse.ArgumentParser(description=DESCRIPTION,
                                     formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("directory", type=Path, help="output directory of a run")
    parser.add_argument("--output", type=Path, metavar="FILE.html",
                        help="default: report.html in that directory")
    parser.add_argument("--states", type=int, metavar="N", help="at most so many states in 3-D; 0: "
                        "no 3-D view; default: all\nthat stay below --limit")
    parser.add_argument("--fields", metavar="A,B,...", help="columns of the "
                        "cells that can give the colour")
    parser.add_argument("--limit", type=float, default=30, metavar="MB",
                        help="of the cells in the page, MB; default: 30")
    parser.add_argument("--no-pictures", dest="pictures",
                        action="store_false", help="no still pictures")
    parser.add_argument("--morula", type=Path, help="the executable, for the defaults of the keys; "
                        "default:\nbuild/morula, or the one in the path, if there is one")
    return parser.parse_args(words)


def check(run, options):
    """Throws Refused for what cannot be done, before any work."""
    if options.states is not None and options.states < 0:
        raise Refused("--states", options.states, "a number >= 0")
    if not options.limit > 0:
        raise Refused("--limit", options.limit, "a number of MB > 0")
    options.output = options.output or run.directory / "report.html"
    if options.output.is_dir() or not options.output.parent.is_dir():
        raise Refused("--output", options.output, "a file in a directory " "that exists")
    if options.fields is not None:
        options.fields = [f.strip() for f in options.fields.split(",")]
        if not len(run.times):
            raise Refused("--fields", ",".join(options.fields), "nothing for "
                          "a run without cells", "Leave it out.")
        there = fields_of(run.cells(-1))
        for field in options.fields:
            if field not in there:
                raise Refused("--fields", field, "a column of the cells: " + ", ".join(there))


def find_program(wanted):
    """The program that was named, or the usual one if it works here, or None."""
    try:
        program = Program(wanted or MORULA)  # which must be an executable
        program.defaults  # that of another machine fails
        return program
    except (Refused, OSError):
        if wanted is not None:
            raise
        return None


def main(words=None):
    sys.stdout.reconfigure(errors="backslashreplace")
    options = arguments(words)
    return run_tool("report", lambda: report(options), "no page was written")


def report(options):
    run = Run(options.directory)
    check(run, options)
    write(options.output, page(run, find_program(options.morula), options))
    print(f"report: {options.output}, {options.output.stat().st_size / 1e6:.1f} MB")
    return 0
