# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Kinds of bad input, and what the program must say about each: the key with its
full path (or the option, or the file), the value, the limit, and what to do."""
import struct
from dataclasses import dataclass, field

CYCLE = "Proliferation/Cell cycle/"
CONDITIONS = "Boundary conditions/"


@dataclass(frozen=True)
class Refusal:
    """keys: overrides of tests/programs/small-cube.prm; {files} in a value is the
    directory of files: name -> text or bytes. key, value, limit and remedy must
    be in the message."""

    name: str
    keys: dict
    key: str
    value: str
    limit: str
    remedy: str
    files: dict = field(default_factory=dict)


def wrong(name, key, value, limit, remedy, **others):
    """A single key with a bad value; others: further overrides."""
    return Refusal(name, {key: value, **others.pop("keys", {})}, key,
                   f"'{value}'", limit, remedy, **others)


NUMBERS = [
    wrong("no number", "Time/End time", "long", "a number", "Correct the value"),
    wrong("a number with its unit", "Grid/Spacing", "50 um", "a number",
          "the default is '50' um"),
    wrong("not a number", "Tissue/Radius", "nan", "a number",
          "Correct the value"),
    wrong("infinite", "Time/End time", "inf", "a number", "Correct the value"),
    wrong("no integer", "Time/Stop at cells", "1.5", "an integer >= 0",
          "Correct the value"),
    wrong("negative number of points", "Tissue/Boundary points", "-5",
          "an integer >= 0", "Correct the value"),
    wrong("no boolean", "Grid/Extension", "maybe", "true or false",
          "Correct the value"),
    wrong("too short a list", "Tissue/Size", "60, 60", "3 numbers in um",
          "one number for each direction"),
    wrong("dimension", "Dimension", "4", "from 2 to 3", "Correct the value"),
    wrong("grid spacing", "Grid/Spacing", "-50", "a length in um > 0",
          "Choose some cell spacings"),
    wrong("no grid spacing", "Grid/Spacing", "0", "a length in um > 0",
          "Choose some cell spacings"),
    wrong("cell spacing", "Tissue/Cell spacing", "-10", "above 0 um",
          "Give a positive length"),
    Refusal("negative size", {"Tissue/Size": "60, -60, 60"}, "Tissue/Size",
            "'-60'", "above 0 um", "Give a positive length"),
    wrong("negative radius", "Tissue/Radius", "-1", "above 0 um",
          "Give a positive length", keys={"Tissue/Shape": "sphere"}),
    wrong("cells that do not fit", "Tissue/Cell spacing", "130",
          "in um by which at least one cell's centre lies inside",
          "Choose a smaller spacing"),
    Refusal("far away", {"Tissue/Center": "1e300, 0, 0"}, "Tissue/Center",
            "'1e+300, 0, 0'",
            "1e+08 grid spacings from the origin, 3.5e+09 um",
          "Move the scene nearer"),
    wrong("incompressible", "Material/Poisson's ratio", "0.5", "< 0.5",
          "0.49 or 0.499"),
    wrong("ratio too low", "Material/Poisson's ratio", "-1", "> -1",
          "0.49 or 0.499"),
    wrong("no stiffness", "Material/Young's modulus", "0", "> 0 kPa",
          "positive stiffness"),
    wrong("penalty", CONDITIONS + "Nitsche penalty", "-1",
          "> 0, in units of E/h", "1e3 is a good choice"),
    wrong("negative relaxation time", "Material/Relaxation time", "-1",
          ">= 0 day", "0 is elastic tissue"),
    wrong("relaxation time negative somewhere", "Material/Relaxation time",
          "X/100", ">= 0 day", "0 is elastic tissue"),
    wrong("negative yield stress", "Material/Yield stress", "-1", ">= 0 kPa",
          "With 0 any shear stress relaxes"),
    wrong("no pass", "Material/Relaxation passes", "0",
          "from 1 to 10000", "Correct the value"),
    wrong("contraction to nothing", "Contraction/Stretch", "0",
          "> 0 (a ratio of lengths)", "1 is no contraction"),
    wrong("contraction below zero somewhere", "Contraction/Stretch", "X",
          "> 0 (a ratio of lengths)", "1 is no contraction",
          keys={"Contraction/Direction": "0; 0; 1"}),
    wrong("contraction without direction", "Contraction/Direction", "0; 0; 0",
          "a vector that is not zero, 'radial' or 'surface normal'",
          "Choose a direction that all cells have",
          keys={"Contraction/Stretch": "0.9"}),
    wrong("contraction without direction somewhere", "Contraction/Direction",
          "X > 0; 0; 0", "a vector that is not zero",
          "It is zero at the cell from (", keys={"Contraction/Stretch": "0.9"}),
    wrong("direction without contraction", "Contraction/Direction", "radial",
          "its default, as Contraction/Stretch is not set",
          "Set Contraction/Stretch, or remove this key"),
    wrong("no step", "Time/Step", "0", "days > 0", "Choose a positive step"),
    wrong("no end", "Time/End time", "-1", "days > 0", "Choose a later end"),
    wrong("end at the start", "Time/End time", "0", "days > 0",
          "Choose a later end"),
    wrong("smallest step", "Time/Smallest step", "1",
          "<= Time/Step = 0.125 day", "Lower it, or raise Time/Step"),
    wrong("steps without number", "Time/Step", "1e-10",
          "at least Time/End time = 1 day / 1e+09", "Raise it",
          keys={"Time/Smallest step": "1e-11"}),
    wrong("occupation", "Grid/Occupation parameter", "1.5", "<= 1",
          "0.85 is a good choice"),
    wrong("tolerance", "Solver/Newton tolerance", "0", "> 0 and < 1",
          "1e-6 is a good choice"),
    wrong("output interval", "Output/Interval", "-1", "a number >= 0",
          "the default is '0.25' day"),
    wrong("cycle of no length", CYCLE + "Duration", "0", "> 0 day",
          "duration of a cycle"),
    wrong("negative rate", CYCLE + "G0 exit rate", "-1", ">= 0 1/day",
          "wait forever"),
    wrong("negative checkpoint", CYCLE + "Size checkpoint", "-0.5", ">= 0",
          "0 means no checkpoint"),
]

CHOICES = [
    Refusal("unknown key", {"Grid/Spcing": "50"}, "Grid/Spcing", "'50'",
            "a key that exists", "Did you mean 'Grid/Spacing'?"),
    Refusal("unknown section", {"Gird/Spacing": "50"}, "Gird/Spacing", "'50'",
            "a section that exists", "Did you mean 'Grid/Spacing'?"),
    Refusal("a key in the wrong section", {"Growth/Stretch": "2"},
            "Growth/Stretch", "'2'", "a key that exists",
            "That name stands in subsection Growth/Isotropic, and in "
            "subsection Contraction."),
    Refusal("a key outside its section", {"Spacing": "50"}, "Spacing", "'50'",
            "a key that exists", "That name stands in subsection Grid."),
    wrong("misspelt choice", "Tissue/Shape", "spere", "any one of sphere, box",
          "Did you mean 'sphere'?"),
    wrong("misspelt choice in a list", "Output/Formats", "csv, vtuu",
          "any one of vtu, csv, none", "Did you mean 'vtu'?"),
    wrong("unknown choice", "Tissue/Shape", "torus", "any one of sphere, box",
          "Correct the value"),
    wrong("no cylinder in 2-D", "Tissue/Shape", "cylinder",
          "sphere, box, ellipsoid or points in 2-D", "set Dimension = 3",
          keys={"Dimension": "2"}),
    wrong("contradicting formats", "Output/Formats", "none, csv", "none alone",
          "Remove 'none' or the others"),
    wrong("a format twice", "Output/Formats", "csv, csv", "each format once",
          "Remove what is written twice"),
]

EXPRESSIONS = [
    wrong("stiffness negative somewhere", "Material/Young's modulus", "X",
          "> 0 kPa", "It is -24 kPa at (-24 -24 6) um. Make it positive"),
    wrong("unknown variable", "Growth/Isotropic/Stretch", "1 + 0.1*tt",
          "an expression that muParser understands",
          'character 9: Unexpected token "tt". The variables are X, Y, Z, t, x, '
          "y, z, generation, age", keys={"Growth/Law": "isotropic"}),
    wrong("open bracket", CONDITIONS + "Slip where", "(Z <= 0",
          "an expression that muParser understands", "Missing parenthesis"),
    wrong("too few components", CONDITIONS + "Traction", "1",
          "3 expressions separated by ';'", "There are 1.",
          keys={CONDITIONS + "Traction where": "Z > 59"}),
    wrong("growth that ends below zero", "Growth/Isotropic/Stretch",
          "1 - 1.5*t", "> 0", "stays positive until End time",
          keys={"Growth/Law": "isotropic"}),
    wrong("time in a place", CONDITIONS + "Fixed where", "Z < t",
          "an expression of X, Y, Z", "remove t"),
    wrong("condition that holds nowhere", CONDITIONS + "Fixed where",
          "Z < -100", "holds at some boundary point",
          "correct it, or leave it empty"),
    wrong("no value", "Body force/Force density", "0; 0; log(-1)",
          "a finite value", "t = 0 day"),
]

PLANE = {"Dimension": "2", CONDITIONS + "Slip where": "",
         CONDITIONS + "Slip normal": ""}


def without_z(key, value, **keys):
    return wrong(f"Z in 2-D, {key}", key, value, "an expression without Z in 2-D",
                 "write it with X and Y, or set Dimension = 3",
                 keys={name: text for name, text in {**PLANE, **keys}.items()
                       if name != key})


IN_2D = [
    without_z("Material/Young's modulus", "1 + (Z > 0)"),
    without_z("Growth/Isotropic/Stretch", "1 + 0.1*t*Z",
              **{"Growth/Law": "isotropic"}),
    *(without_z(CYCLE + key, value) for key, value in (
        ("Duration", "2 + Z/100"), ("G0 exit rate", "exp(Z)"),
        ("Size checkpoint", "if(Z > 0, 0.5, 0)"), ("Where", "Z > 40"))),
    *(without_z(CONDITIONS + key, "Z <= 0") for key in (
        "Fixed where", "Slip where", "Traction where", "Pressure where")),
    *(without_z(CONDITIONS + key, value,
                **{CONDITIONS + f"{effect} where": "X < 0"})
      for effect, key, value in (
          ("Fixed", "Displacement", "0; 0.1*t*Z; 0"),
          ("Traction", "Traction", "0; 0; Z"),
          ("Pressure", "Pressure", "Z"))),
    without_z("Body force/Force density", "0; -Z; 0"),
]

RATE = {"Growth/Law": "rate"}
GROWTH_BY_RATES = [
    wrong("a share without direction", "Growth/Rate/Share along", "0",
          "1/3 or empty without Growth/Rate/Direction",
          "Say along which Direction", keys=RATE),
    wrong("a share above 1", "Growth/Rate/Share along", "1.5",
          "a share from 0 to 1", "It is 1.5",
          keys={**RATE, "Growth/Rate/Direction": "0; 0; 1"}),
    wrong("a direction of no length", "Growth/Rate/Direction", "0; 0; 0",
          "a vector that is not zero", "Choose a direction that all cells have",
          keys={**RATE, "Growth/Rate/Share along": "0"}),
    wrong("another word for a direction", "Growth/Rate/Direction", "outwards",
          "3 expressions separated by ';'", "There are 1.",
          keys={**RATE, "Growth/Rate/Share along": "0"}),
    wrong("cells that vanish in a step", "Growth/Rate/Rate", "-500",
          "a rate that leaves cells between 1e-6 and 1e300 of their volume",
          "Let the rate end", keys=RATE),
    wrong("a rate without value", "Growth/Rate/Rate", "log(J_e - 1)",
          "a finite value", "t = ", keys=RATE),
    wrong("homeostasis that flees its stress", "Growth/Rate/Homeostasis", "-1",
          "a value >= 0 1/(day kPa)", "0 is no growth by stress", keys=RATE),
]

CONTRADICTIONS = [
    wrong("a cell cycle of nobody", CYCLE + "Where", "Z > 400",
          "a condition that holds at some founder",
          "correct it, or set Proliferation/Law = none"),
    wrong("growth without its law", "Growth/Isotropic/Stretch", "1 + t",
          "its default, as Growth/Law is not set",
          "Set Growth/Law = isotropic, or remove this key"),
    wrong("pressure nowhere", CONDITIONS + "Pressure", "1",
          "its default, as Boundary conditions/Pressure where is not set",
          "Say where it acts"),
    wrong("normal without direction", CONDITIONS + "Slip normal", "0, 0, 0",
          "not all zero", "Write for example 0, 1, 0"),
    wrong("axis without direction", CYCLE + "Fixed axis", "0, 0, 0",
          "is not zero", "set Division axis = random",
          keys={CYCLE + "Division axis": "fixed"}),
    wrong("axis that is zero for some", CYCLE + "Fixed axis", "X > 0; 0; 0",
          "it is zero for the cell whose founder was at (",
          "set Division axis = random",
          keys={CYCLE + "Division axis": "fixed"}),
    wrong("axis of two components", CYCLE + "Fixed axis", "1; 1",
          "3 expressions separated by ';'", "components are separated by ';'",
          keys={CYCLE + "Division axis": "fixed"}),
    wrong("unknown axis", CYCLE + "Division axis", "longest",
          "random, fixed, stretch, stress, radial, surface normal, tangential",
          "Correct the value"),
    wrong("negative spread", CYCLE + "Axis spread", "-1",
          "a value >= 0 (a concentration)", "0 means no spread",
          keys={CYCLE + "Division axis": "stretch"}),
    wrong("spread that is negative for some", CYCLE + "Axis spread", "X",
          "a value >= 0 (a concentration)", "0 means no spread",
          keys={CYCLE + "Division axis": "stretch"}),
    wrong("spread of nothing", CYCLE + "Axis spread", "5",
          "its default, as Proliferation/Cell cycle/Division axis is not set",
          "or remove this key"),
    wrong("least anisotropy below 1", CYCLE + "Least anisotropy", "0.9",
          "a ratio of at least 1", "1 lets every cell follow its stretch",
          keys={CYCLE + "Division axis": "stretch"}),
    wrong("center of no radial axis", CYCLE + "Radial center", "1; 0; 0",
          "its default, as Proliferation/Cell cycle/Division axis is not set",
          "Division axis = radial, or remove this key"),
    wrong("step above T/2", "Time/Step", "0.6",
          "half the shortest cell cycle, 0.5 day",
          "lengthen Proliferation/Cell cycle/Duration"),
    Refusal("step above T/2 of some founder",
            {CYCLE + "Duration": "1 - 0.9*(X > 0)"}, "Time/Step", "'0.125'",
            "half the shortest cell cycle, 0.05 day", "Shorten the step"),
    wrong("points without a surface", CONDITIONS + "Slip where", "Z <= 0",
          "nothing, as Tissue/Points surface = none",
          "Remove the condition, or set Points surface = automatic",
          keys={"Tissue/Shape": "points", "Tissue/Points surface": "none",
                "Tissue/Points file": "scattered-cells.csv"}),
    wrong("points on the surface of none", "Tissue/Boundary points", "100",
          "0, as Tissue/Points surface = none", "Set Boundary points = 0",
          keys={**dict.fromkeys((CONDITIONS + "Slip where",
                                 CONDITIONS + "Slip normal"), ""),
                "Tissue/Shape": "points", "Tissue/Points surface": "none",
                "Tissue/Points file": "scattered-cells.csv"}),
    wrong("a mesh for a box", "Tissue/Surface mesh", "octahedron.off",
          "nothing, as Tissue/Shape = box", "Set Shape = mesh"),
    wrong("too many cells", "Tissue/Cell spacing", "0.01",
          "in um that gives fewer than 4e9 cells", "Choose a larger spacing"),
    Refusal("more than memory", {"Tissue/Cell spacing": "0.04"}, "The scene",
            "3.375e+09 cells of 0.04 um on a grid of 35 um", "GB of memory here",
            "Raise Tissue/Cell spacing or Grid/Spacing"),
    Refusal("a grid larger than memory",
            {"Grid/Spacing": "0.08", "Tissue/Cell spacing": "0.7"}, "The scene",
            "on a grid of 0.08 um", "GB of memory here",
            "Raise Tissue/Cell spacing or Grid/Spacing"),
    wrong("cells far longer than grid cells", "Tissue/Cell spacing", "20",
          "at most 10 times Grid/Spacing, 10 um",
          "Choose a smaller spacing, or a larger Grid/Spacing",
          keys={"Grid/Spacing": "1"}),
    Refusal("a box far too long", {"Tissue/Size": "60, 1e9, 60"}, "Tissue/Size",
            "'1e+09'", "at most 1000 times Grid/Spacing long, 35000 um",
            "Choose a smaller tissue"),
    wrong("a sphere far too large", "Tissue/Radius", "20000",
          "at most 1000 times Grid/Spacing long, 35000 um",
          "Choose a smaller tissue", keys={"Tissue/Shape": "sphere"}),
]

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
           "x,y,w", "the columns x, y, z", "Name the columns"),
    points("a column too few", "x,y,z\n1,2\n", " ({files}/cells.csv, line 2)",
           "'1,2'", "3 numbers separated by commas", "Correct the line"),
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
    points("an unknown column", "x,y,z,age\n1,2,3,0\n",
           " ({files}/cells.csv, line 1)", "x,y,z,age",
           "the columns x, y, z and, if there, volume, generation, phase "
           "and type",
           "Name the columns"),
    points("the same point twice", "x,y,z\n0,0,0\n30,0,0\n0,0,0\n",
           " ({files}/cells.csv, line 4)", "'0, 0, 0'",
           "one cell at each place, in um, and line 2",
           "Drop one of the two cells"),
]

APART = "x,y,z,volume\n" + "".join(f"{50 * i},0,0,1000\n" for i in range(9))

BLOCK = "".join(f"{12 * i},{12 * j},{12 * k}\n"
                for i in range(5) for j in range(5) for k in range(5))
CSV = " ({files}/cells.csv, line 127)"
LONG = 50 * 1000 * 1000


def astray(place):
    """125 cells side by side, and another one."""
    where = ", ".join(format(float(x), "g") for x in place.split(","))
    return points(f"a cell at {place}", "x,y,z\n" + BLOCK + place + "\n", CSV,
                  where, "at most 35000 um",
                  "farthest from the others: correct or drop it")


def large(volume):
    rows = BLOCK.replace("\n", ",1728\n")
    return points(f"a cell of {volume} um^3",
                  f"x,y,z,volume\n{rows}90,0,0,{volume}\n", CSV,
                  f"'{float(volume):g}'", "no longer than 350 um", "raise Grid/Spacing")


def spike(x):
    return mesh(f"a vertex at {x}", "mesh.off",
                OFF.replace("64 0 0", f"{x} 0 0"), "at most 35000 um",
                "correct the vertex that lies astray")


# Each would fill the memory, or go on for hours, if it were taken seriously.
OUTLIERS = [
    *map(astray, ("1e6,0,0", "0,-1e9,0")),
    *(points(f"a cell at {x} um", "x,y,z\n" + BLOCK + f"0,0,{x}\n", CSV, value,
             "at most 3.5e+09 um", "Correct the line")
      for x, value in (("7e10", "0, 0, 7"), ("-1e308", "0, 0, -1e+308"))),
    Refusal("a surface around cells that lie singly",
            {**NO_SLIP, "Tissue/Shape": "points",
             "Tissue/Points file": "{files}/cells.csv",
             "Tissue/Points surface": "always"}, "Tissue/Points file",
            "cells.csv", "cells side by side",
            "It would have 9 parts for 9 cells", {"cells.csv": APART}),
    points("cells far from the origin", "x,y,z\n1e11,0,0\n1e11,12,0\n",
           " ({files}/cells.csv, line 2)", "0, 0'",
           "from the origin", "Correct the line"),
    points("a cell across the diagonal", "x,y,z\n" + BLOCK + "1e4,1e4,1e4\n",
           "", "cells.csv", "fills a part of the grid around it",
           "correct the cell that lies astray"),
    *map(large, ("1e12", "1e308")),
    *map(spike, ("1e5", "1e6", "-1e7")),
    mesh("a vertex across the diagonal", "mesh.off",
         OFF.replace("64 0 0", "1e4 1e4 1e4"), "fills a part of the grid",
         "correct the vertex that lies astray"),
    mesh("a mesh far from the origin", "mesh.off",
         OFF.replace("\n0 0 0", "\n1e12 0 0", 1).replace("64 0 0", "1e12 64 0")
         .replace("0 64 0", "1e12 0 64").replace("\n0 0 64", "\n999999999936 0 0"),
         "at most 3.5e+09 um from the origin", "move the scene nearer"),
    points("a null byte", b"x,y,z\n1,2,3\n4,\0005,6\n",
           " ({files}/cells.csv, line 3)", "'\\x005'",
           "a finite number with a decimal point", "Correct the line"),
    points("an endless line", "x,y,z\n" + "1," * (LONG // 2) + "\n",
           " ({files}/cells.csv, line 2)", "'1,1,1", "3 numbers separated",
           "Correct the line"),
    points("an endless header", "x,y,z," * (LONG // 6) + "\n",
           " ({files}/cells.csv, line 1)", "'x,y,z,x,y,z", "each once",
           "Name the columns"),
]

KEYS = NUMBERS + CHOICES + EXPRESSIONS + IN_2D + GROWTH_BY_RATES + \
    CONTRADICTIONS + FILES + OUTLIERS

# Scenes of their own: (name, text or None, words that must be in the message).
SCENES = [
    ("missing", None, ("The scene file", "a .prm file that can be read",
                       "Correct its name")),
    ("directory", "", ("The scene file", "a .prm file that can be read",
                       "Correct its name")),
    ("foreign", b"PK\x03\x04\0\0", ("foreign.prm:1", "'PK'", "text",
                                   "Is this a scene?")),
    ("word", b"sett Dimension = 3\n", ("word.prm:1", "'sett Dimension = 3'",
                                       "'set Key = value'",
                                       "Did you mean 'set'?",
                                       "Correct the line")),
    ("equals", b"set Dimension 3\n", ("equals.prm:1", "'set Dimension 3'",
                                      "'set Key = value'", "Put '='")),
    ("truncated", b"subsection Grid\n  set Spacing = 5\n",
     ("truncated.prm:1: subsection = 'Grid'", "closed by 'end'",
      "Add the missing 'end'", "ends with line 2")),
    ("unclosed", b"subsection Tissue\n  set Shape = box\nsubsection Grid\nend\n",
     ("unclosed.prm:1: subsection = 'Tissue'", "closed by 'end'",
      "Add the missing 'end'", "ends with line 4")),
    ("an end astray",
     b"subsection Tissue\n  set Shape = box\nsubsection Grid\nend\nend\n",
     ("astray.prm:3: subsection = 'Tissue/Grid'", "a section that exists",
      "astray.prm:1 is still open here: is an 'end' missing?")),
    ("late", b"\nsubsection Tissue\n  set Shape = box\nend\n"
     b"subsection Material\n  set Young's modulus = X\nend\n",
     ("late.prm:6: Material/Young's modulus = 'X'", "> 0 kPa",
      "Make it positive")),
    ("without set", b"Dimension = 3\n",
     ("without set.prm:1", "'Dimension = 3'", "'set Key = value'",
      "begins with 'set'")),
    ("without subsection", b"Tissue\n  set Radius = 3\nend\n",
     ("without subsection.prm:1", "'Tissue'", "'subsection Name'",
      "A section begins with 'subsection'")),
    ("end", b"set Dimension = 3\nend\n", ("end.prm:2", "'end'",
                                          "an 'end' for every 'subsection'",
                                          "remove the 'end'")),
    ("key", b"subsection Grid\n  set Spacng = 5\nend\n",
     ("key.prm:2: Grid/Spacng", "'5'", "a key that exists",
      "Did you mean 'Grid/Spacing'?")),
    ("section", b"\nsubsection Grwoth\nend\n",
     ("section.prm:2: subsection", "'Grwoth'", "a section that exists",
      "Did you mean 'Growth'?")),
    ("choice", b"subsection Tissue\n  set Shape = spere\nend\n",
     ("choice.prm:2: Tissue/Shape", "'spere'", "any one of sphere",
      "Did you mean 'sphere'?")),
    ("include", b"include nowhere.prm\n",
     ("include.prm:1", "'include nowhere.prm'", "a file that can be read",
      "Correct the name")),
    ("circle", b"include circle.prm\n",
     ("circle.prm:1", "'include circle.prm'",
      "files that do not include themselves", "Break the circle")),
]
