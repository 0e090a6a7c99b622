# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Meshes and points files that cannot be read."""
import struct

from tests.common.refusals.refusal import CONDITIONS, Refusal

OFF = """OFF
4 4 0
0 0 0
64 0 0
0 64 0
0 0 64
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
"""
NO_SLIP = {CONDITIONS + "Slip where": "", CONDITIONS + "Slip normal": ""}


def mesh(name, file, content, limit, remedy, value=None):
    path = "{files}/" + file
    return Refusal(name, {**NO_SLIP, "Tissue/Shape": "mesh",
                          "Tissue/Surface mesh": path}, "Tissue/Surface mesh",
                   value or path, limit, remedy,
                   {} if content is None else {file: content})


def points(name, content, key, value, limit, remedy):
    return Refusal(name, {**NO_SLIP, "Tissue/Shape": "points",
                          "Tissue/Points file": "{files}/cells.csv"},
                   "Tissue/Points file" + key, value, limit, remedy,
                   {} if content is None else {"cells.csv": content})


BINARY_STL = bytes(80) + struct.pack("<I", 4) + bytes(120)

FILES = [
    mesh("missing mesh", "nowhere.stl", None, "a file that can be read",
         "Check its name"),
    mesh("mesh of another format", "mesh.vtk", OFF,
         ".stl, .off, .ply or .obj", "Convert the surface"),
    mesh("foreign mesh", "mesh.obj", "once upon a time\n", "a closed surface",
         "Tissue/Surface mesh"),
    mesh("empty mesh", "mesh.ply", "", "a closed surface", "file is empty"),
    mesh("truncated mesh", "mesh.off", OFF[:-12], "a closed surface",
         "cannot be read"),
    mesh("truncated binary mesh", "mesh.stl", BINARY_STL, "a closed surface",
         "cut off"),
    mesh("open mesh", "mesh.off", OFF.replace("4 4 0", "4 3 0", 1)
         .replace("3 1 2 3\n", ""), "a closed surface", "open: 3 edges"),
    mesh("mesh with a fin", "mesh.off", OFF.replace("4 4 0", "5 5 0", 1)
         .replace("0 0 64\n", "0 0 64\n90 90 90\n") + "3 0 1 4\n",
         "a closed surface", "non-manifold: 1 edges"),
    mesh("mesh that intersects itself", "mesh.off",
         OFF.replace("4 4 0", "8 8 0").replace(
             "3 0 2 1", "10 10 10\n74 10 10\n10 74 10\n10 10 74\n3 0 2 1")
         + "3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n",
         "does not intersect itself", "pairs of triangles"),
    mesh("mesh of no numbers", "mesh.off", OFF.replace("64 0 0", "nan 0 0"),
         "a closed surface", "Tissue/Surface mesh"),
    mesh("mesh in metres", "mesh.off", OFF.replace("64", "64e-6"),
         "a surface in um", "1e6 from m"),
    points("missing points", None, "", "cells.csv", "a file that can be read",
           "Check its name"),
    points("empty points", "", " ({files}/cells.csv, line 1)", "''",
           "a header line and one line per cell", "The file is empty"),
    points("points without cells", "x,y,z\n", "", "cells.csv",
           "a file with 1 to 4e9 cells", "It has 0."),
    points("bad columns", "x,y,w\n1,2,3\n", " ({files}/cells.csv, line 1)",
           "x,y,w", "the columns x, y, z", "There is no column 'z'"),
    points("a column twice", "x,y,z,X\n1,2,3,4\n",
           " ({files}/cells.csv, line 1)", "x,y,z,X", "each once",
           "There are 2 columns 'x'"),
    points("no header", "1,2,3\n4,5,6\n", " ({files}/cells.csv, line 1)",
           "1,2,3", "a header line", "This line has numbers only"),
    points("points in nanometres", "x (nm),y (nm),z (nm)\n1,2,3\n",
           " ({files}/cells.csv, line 1)", "z (nm)", "coordinates in um",
           "The file says 'nm'"),
    points("points of several moments", "x,y,z,FRAME\n1,2,3,0\n1,2,4,1\n",
           "", "cells.csv", "the cells of one moment", "goes from 0 to 1"),
    points("points in UTF-16", "\0x\0,\0y\0,\0z\0\n",
           " ({files}/cells.csv, line 1)", "''", "a table as text",
           "save it as CSV in UTF-8"),
    points("decimal commas", "x;y;z\n1,5;2;3\n",
           " ({files}/cells.csv, line 2)", "'1,5'", "a decimal point",
           "instead of decimal commas"),
    points("a column too few", "x,y,z\n1,2\n", " ({files}/cells.csv, line 2)",
           "'1,2'", "3 entries separated by commas", "This line has 2"),
    points("points of no numbers", "x,y,z\n1,nan,3\n",
           " ({files}/cells.csv, line 2)", "'nan'",
           "a finite number with a decimal point, in um", "Correct the line"),
    points("a cell of no volume", "x,y,z,volume\n1,2,3,0\n",
           " ({files}/cells.csv, line 2)", "'1,2,3,0'",
           "a volume above 0 um^3", "drop the cell"),
    points("half a generation", "x,y,z,generation\n1,2,3,0\n30,2,3,0.5\n",
           " ({files}/cells.csv, line 3)", "'30,2,3,0.5'",
           "a whole number from 0 to 1000", "counts the divisions"),
    points("a negative generation", "x,y,z,generation\n1,2,3,-1\n",
           " ({files}/cells.csv, line 2)", "'1,2,3,-1'",
           "a whole number from 0 to 1000", "counts the divisions"),
    points("a founder in M", "phase,x,y,z\n0,1,2,3\n3,30,2,3\n",
           " ({files}/cells.csv, line 3)", "'3,30,2,3'",
           "0 (G0), 1 (S), 2 (G2), 4 (G1) or 9", "no phase that lasts"),
    points("a type in a scene without types", "x,y,z,type\n1,2,3,stem\n",
           " ({files}/cells.csv, line 2)", "'stem'",
           "no column 'type', as the scene has no types of cells",
           "name the type in the scene"),
    points("the same point twice", "x,y,z\n0,0,0\n30,0,0\n0,0,0\n",
           " ({files}/cells.csv, line 4)", "'0, 0, 0'",
           "one cell at each place, in um, and line 2",
           "Drop one of the two cells"),
]
