# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tools of contrib/upkeep, for those who work on Morula: they write pages. Only
Morula's tree has this package; an installation has `morula` alone."""
import argparse
import sys
from pathlib import Path

from morula.execute import call

ROOT = Path(__file__).resolve().parents[3]


def parser(description):
    """The command line of a tool, with line ends as they are."""
    return argparse.ArgumentParser(description=description,
                                   formatter_class=argparse.RawTextHelpFormatter)


def said(*words):
    """What a command prints, from the root; throws RuntimeError if it fails."""
    print("+", *words, file=sys.stderr, flush=True)
    ended = call(words, cwd=ROOT, stderr=None, env={"COLUMNS": "80"})
    if ended.code:
        raise RuntimeError(f"{words[0]} ended with exit code {ended.code}")
    return ended.stdout.strip()
