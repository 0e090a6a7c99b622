# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Files with a point, a vertex or a line that is far too large."""
from tests.common.refusals.files import NO_SLIP, OFF, mesh, points
from tests.common.refusals.refusal import Refusal

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
           " ({files}/cells.csv, line 1)", "a table as text",
           "bytes that no text has", "save it as CSV in UTF-8"),
    points("an endless line", "x,y,z\n" + "1," * (LONG // 2) + "\n",
           " ({files}/cells.csv, line 2)", "'1,1,1", "3 entries separated",
           "complete it"),
    points("an endless header", "x,y,z," * (LONG // 6) + "\n",
           " ({files}/cells.csv, line 1)", "'x,y,z,x,y,z", "each once",
           "too long for a header"),
]
