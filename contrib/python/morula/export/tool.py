# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command morula export."""
import argparse
from pathlib import Path

from morula.command_line import Parser, lengths, run_tool
from morula.refusal import Refused
from morula.run import Run

DESCRIPTION = """Writes a run for other programs; the ending of a file says how.

    morula export output/bud tracks.geff          all cells over time, as a graph
    morula export output/bud cells.h5ad           the last state, for scanpy
    morula export output/bud cells.h5ad --all     all states in one table
    morula export output/bud cells.vtkhdf         all states, for ParaView
    morula export output/bud portal.csv           all states, as OpenVT's portal has them
    morula export output/bud labels.tif --voxel 2 every voxel has its cell's label
    morula export output/bud labels.tif --voxel 1,1,4 --all

doc/python.md explains the files.
"""
# Those that are no images, and of them those that have all states.
TABLES = (".geff", ".h5ad", ".vtkhdf", ".csv")
OVER_TIME = (".geff", ".vtkhdf", ".csv")
ENDINGS = (*TABLES, ".tif", ".tiff", ".npy")


def parser():
    result = Parser(allow_abbrev=False, description=DESCRIPTION,
                    formatter_class=argparse.RawTextHelpFormatter)
    add = result.add_argument
    add("directory", type=Path, help="output directory of a run, finished or not")
    add("file", type=Path, nargs="+", metavar="FILE",
        help=".geff: tracks; .h5ad: annotated data; .vtkhdf: points\n"
        "over time; .csv: their places; .tif (OME), .npy: a label image, id + 1, of the cells' regions")
    add("--time", metavar="DAY", help="of the state; default: the last one " "written")
    add("--all", action="store_true", help="all states; each one's image is " "FILE-NNNN")
    add("--voxel", metavar="X,Y,Z", help="edges of the voxels of an image, or " "one for all, um")
    add("--again", action="store_true", help="replace files from before")
    return result


def kind_of(file):
    """Of a file by its ending: one of TABLES, or "image"."""
    ending = file.suffix.lower()
    return ending if ending in TABLES else "image"


def check(options):
    """Before anything is read; returns the edges of voxels, or None."""
    kinds = {kind_of(file) for file in options.file}
    for file in options.file:
        if file.suffix.lower() not in ENDINGS:
            raise Refused("The file", file, "a name that ends in one of " + ", ".join(ENDINGS))
        if not file.parent.is_dir():
            raise Refused("The file", file, "a file in a directory that exists")
        if (file.exists() and not options.again) or (file.is_dir() and kind_of(file) != ".geff"):
            raise Refused("The file", file, "a name that is free",
                          "Choose another one, or replace that one with --again.")
    if options.voxel and "image" not in kinds:
        raise Refused("--voxel", options.voxel, "nothing without an image")
    if kinds <= set(OVER_TIME) and (options.all or options.time is not None):
        raise Refused("--time, --all", "", "nothing for files over time alone",
                      "They have all states.")
    if "image" not in kinds:
        return None
    edges = lengths("--voxel", options.voxel, (1, 2, 3))
    return edges * 3 if len(edges) == 1 else edges


def export(options):
    from morula.shapes.tool import chosen_states
    voxel = check(options)
    run = Run(options.directory)
    if voxel is not None and len(voxel) < run.dimension:
        raise Refused("--voxel", options.voxel, "three edges, for a run in 3-D")
    for file in options.file:
        if kind_of(file) == ".geff":
            from . import geff, tracks
            found = tracks.tracks_of(run)
            geff.write(found, file)
            print(f"export: {file}: {len(run.lineage)} cells, {len(found)} nodes, "
                  f"{len(found.edges)} edges")
        elif kind_of(file) in TABLES:
            from . import h5ad, portal, vtkhdf
            rows, columns = (h5ad.write(run, chosen_states(run, options), file) if kind_of(file)
                             == ".h5ad" else {".vtkhdf": vtkhdf, ".csv": portal}[kind_of(file)]
                             .write(run, range(len(run.times)), file))
            print(f"export: {file}: {rows} rows, {columns} columns")
        else:
            from . import images
            for written, words in images.write(run, chosen_states(run, options), file, voxel):
                print(f"export: {written}: {words}", flush=True)
    return 0


def main(words=None):
    """Exit code 0; 1 for what makes no sense."""
    return run_tool("export", lambda: export(parser().parse_args(words)))
