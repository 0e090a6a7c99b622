# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command morula shapes."""
import argparse
from pathlib import Path

import numpy as np
from morula.columns import COMPONENTS
from morula.command_line import Parser, run_tool
from morula.expressions import rows_where
from morula.refusal import Refused
from morula.run import Run, states

from .grid import grid_of
from .regions import regions_of_state
from .writing import file_of, write_collection, write_grid

DESCRIPTION = """Writes the cells of a run as polyhedra, for ParaView: the
Voronoi region of each cell among all cells, cut off at the tissue's surface
(2-D: polygons).

    morula shapes output/bud                     the last state
    morula shapes output/bud --all               all states
    morula shapes output/bud --time 1 --where "y < 0 && generation >= 2"

It writes cell-shapes-NNNN.vtu, with the cells' columns, region_volume, neighbours and
touches_surface, and cell-shapes.pvd for all of them: doc/looking-at-results.md.
"""


def arguments(words):
    parser = Parser(description=DESCRIPTION, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("directory", type=Path, help="output directory of a run, finished or not")
    parser.add_argument("--time", metavar="DAY", help="of the state; default: the last one written")
    parser.add_argument("--all", action="store_true", help="all states")
    parser.add_argument("--where", metavar="EXPRESSION", help="write those cells alone for which "
                        "it is true,\nof the columns: 'z > 40 && phase != 9'. All cells "
                        "still\nbound each other's regions")
    parser.add_argument("--output", type=Path, metavar="FILE.vtu",
                        help="of a single state; default: cell-shapes-NNNN.vtu "
                        "in the\nrun's directory, and cell-shapes.pvd")
    return parser.parse_args(words)


def chosen_states(run, options):
    """Their numbers. Throws Refused for what cannot be done."""
    times = [time for time, _ in states(run.directory, "cells")]
    if options.all:
        if options.time is not None:
            raise Refused("--time", options.time, "nothing besides --all",
                          "Leave out one of the two.")
        return list(range(len(times)))
    if options.time is None:
        return [len(times) - 1]
    try:
        distance = np.abs(np.array(times) - float(options.time))
    except ValueError:
        distance = np.array([np.nan])
    if not distance.min() <= 1e-6 * max(1.0, times[-1]):
        raise Refused("--time", options.time, "a day of a state that was "
                      "written: " + ", ".join(f"{t:g}" for t in times))
    return [int(distance.argmin())]


def check_output(options):
    file = options.output
    if file is None:
        return
    if options.all:
        raise Refused("--output", file, "a name for a single state", "Leave it out with --all.")
    if file.suffix != ".vtu" or file.is_dir() or not file.parent.is_dir():
        raise Refused("--output", file, "a name that ends in .vtu, in a " "directory that exists")


def with_vectors(cells):
    """The columns of a state as arrays, and as one vector or tensor besides
    what the run's VTU file has so."""
    columns = {name: cells[name].to_numpy() for name in cells}
    if "displacement_x" in cells:
        columns["displacement"] = np.stack(
            [columns[f"displacement_{axis}"] for axis in "xyz"], axis=1)
        columns["sigma"] = np.stack([columns[name] for name in COMPONENTS["sigma"]], axis=1)
    return columns


def write_state(run, i, options):
    """The regions of a state, as a file; returns what to say of it."""
    time, cells_file = states(run.directory, "cells")[i]
    cells = run.cells(i)
    kept = np.ones(len(cells), dtype=bool)
    if options.where is not None:
        kept = rows_where(options.where, dict(cells), "--where")
        if not kept.any() and not options.all:
            raise Refused("--where", options.where, "what is true for some cell",
                          f"On day {time:g} it is for none of {len(kept)}.")
    regions = regions_of_state(run, i)
    grid = grid_of(regions.bodies, {**with_vectors(cells), **regions.fields}, kept, run.dimension
                   == 2)
    file = options.output or file_of(cells_file)
    write_grid(grid, file)
    return (f"{file}: day {time:g}, {kept.sum()} cells, " f"{file.stat().st_size / 1e6:.1f} MB")


def write_all(options):
    run = Run(options.directory)
    check_output(options)
    for i in chosen_states(run, options):
        print("cell-shapes:", write_state(run, i, options), flush=True)
    if options.output is None:
        print("cell-shapes:", write_collection(run.directory))
    return 0


def main(words=None):
    return run_tool("cell-shapes", lambda: write_all(arguments(words)),
                    "files that were written are whole")
