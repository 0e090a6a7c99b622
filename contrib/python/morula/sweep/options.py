# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The words of the command line."""
import argparse
from pathlib import Path

from morula.command_line import Parser, add_run_options


def parser():
    result = Parser(
        allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Runs a scene with every combination of values of some "
        "keys and with several\nrandom seeds, and writes mean and scatter.",
        epilog="""examples:
  morula sweep bud.prm --samples latin-hypercube.csv --skip-refused
  morula sweep bud.prm --seeds 1-5 \\
      --vary "Proliferation/Cell cycle/Size checkpoint=0,0.9" \\
      --vary "Proliferation/Cell cycle/G0 exit rate=0.5,1,2" --jobs 2

doc/sweeps.md explains the results.""")
    add = result.add_argument
    add("scene", metavar="SCENE.prm")
    add("--vary", action="append", default=[], metavar="KEY=VALUES",
        help="values separated by commas ('|' where they contain some); KEY,KEY=VALUE:VALUE,... "
        "changes keys together; repeated, every combination is run")
    add("--samples", type=Path, metavar="FILE.csv", help="instead of --vary: a line of keys, and a "
        "line of values for each run, as latin hypercubes and posterior samples are")
    add("--skip-refused", action="store_true", help="leave out combinations "
        "that the program refuses, with a word, instead of giving up")
    add("--seeds", metavar="1-5", help="random seeds of each combination; default: the scene's own")
    add("--columns", default="cells,total_volume", metavar="LIST",
        help="measures, as those of morula accuracy, to draw against time and to "
        "show in table.md; default: cells,total_volume")
    add_run_options(add, "output/sweep/SCENE")
    return result
