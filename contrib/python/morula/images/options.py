# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The words of the command line."""
import argparse
from pathlib import Path

import numpy as np

from morula.command_line import Parser, lengths
from morula.places import MORULA
from morula.refusal import Refused

DESCRIPTION = """Makes a scene of a label image (TIFF, OME, PNG, NumPy, cellpose, HDF5,
OME-Zarr, NRRD; axes z, y, x; 0 is no cell) or of a tracker's table (CSV):
cells.csv, the smooth closed surface of the tissue with its cavities, scene.prm.

    morula import labels.tif --voxel 0.5,0.5,2
    morula import labels.npy --voxel 1,1 --output disc
    morula import spots.csv --frame 0

doc/from-an-image.md explains what it does, and what it says of the image.
"""


def parser():
    result = Parser(allow_abbrev=False, description=DESCRIPTION,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    add = result.add_argument
    add("file", type=Path, metavar="IMAGE|TABLE")
    add("--voxel", metavar="X,Y,Z",
        help="size of a voxel in um, in the order x,y,z; default: what the file itself says")
    add("--output", type=Path, metavar="DIRECTORY",
        help="default: the file's name without its ending, in the working directory")
    add("--axes", metavar="TCZYX",
        help="what the axes of the image are; default: what the file says, or zyx, or yx")
    add("--dataset", metavar="NAME", help="of a file with several arrays: the one to take")
    add("--channel", type=int, metavar="N",
        help="of an image with channels: that of the labels, from 0")
    add("--frame", type=int, metavar="N",
        help="of an image or a table with several times: the one to take, from 0, or by a "
        "table's own number")
    add("--smallest", type=float, default=0.05, metavar="SHARE", help="labels smaller than this "
        "share of the median one are crumbs, which are left out; default: 0.05")
    add("--smallest-cavity", type=float, default=1.0, metavar="CELLS",
        help="cavities smaller than so many cells are filled; default: 1")
    add("--fill-gaps", action="store_true", help="give the narrow gaps between labels to the "
        "labels beside them, so that cells get larger")
    add("--types", type=Path, metavar="TABLE.csv",
        help="types of the cells: columns label (in a tracker's table id) and type")
    add("--marker", type=Path, metavar="IMAGE", help="image of the same size: cells in which its "
        "mean is above a threshold are of another type")
    add("--marker-channel", type=int, metavar="N",
        help="the same of a channel of the image itself, or of that of --marker")
    add("--marker-threshold", type=float, metavar="VALUE", help="default: Otsu's")
    add("--marker-names", default="negative,positive", metavar="BELOW,ABOVE",
        help="names of the two types; default: negative,positive")
    add("--surface", type=Path, metavar="MESH", help="of a table: the closed surface around the "
        "cells in um, as STL, OFF, PLY or OBJ, in 2-D WKT; it bounds volumes that are missing")
    add("--again", action="store_true", help="replace files from before")
    add("--morula", default=MORULA, help="the executable; its --explain chooses the grid")
    return result


def voxel_of(text, found, dimension, *others):
    """Edges of a voxel in the order of the axes (z, y, x), um; `found` is what the file says."""
    if text is None:
        if found is None:
            raise Refused("--voxel", "", "the size of a voxel in um, x,y,z",
                          "The file does not say it: give it, such as --voxel 0.5,0.5,2.")
        return np.array(found[-dimension:])
    edges = lengths("--voxel", text, sorted({dimension, 3, *others}))
    return np.array(edges[:dimension][::-1])
