# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The words of the command line."""
import argparse

from morula.command_line import Parser, add_run_options


def parser():
    result = Parser(
        allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Says how accurate the results of a scene are: runs it with "
        "coarser grids,\nlonger steps, other places of the grid and other seeds. With "
        "--vary, draws error\nagainst processor time, unknowns and memory.",
        epilog="""morula accuracy my.prm --measure zmax
morula accuracy my.prm --measure zmax,total_volume \\
    --vary "Grid/Spacing=100,75,50" --vary "Time/Step=2,1,0.5"

doc/accuracy-and-cost.md explains the results.""")
    add = result.add_argument
    add("scene", metavar="SCENE.prm")
    add("--vary", action="append", default=[], metavar="KEY=VALUES",
        help="a ladder: values separated by commas ('|' where they contain "
        "some); KEY,KEY=VALUE:VALUE,... changes keys together; 'NAME: KEY=...' "
        "names it in the figures; may be repeated")
    add("--measure", required=True, metavar="LIST",
        help="columns of statistics.csv, or cells:reduction(column), surface:reduction(column)")
    add("--seeds", metavar="1..8", help="means over these random seeds")
    add("--offsets", metavar="N", help="every run at N positions of the grid, spread through one "
        "grid cell: how far do results depend on where it lies? Needs no --vary")
    add("--reference", metavar="FILE.csv", help="right values, in columns "
        "named like the measures, MEASURE_error, time")
    add_run_options(add, "output/accuracy/SCENE")
    return result
