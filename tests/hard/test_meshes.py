# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Surface meshes that have no inside, and some odd ones that do."""
import struct

import numpy
import pytest

FACES = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
         [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]


def cube(corner=0.0, edge=32.0):
    """Points and triangles of a cube, outward."""
    corner = numpy.broadcast_to(corner, 3)
    return ([tuple(corner[d] + edge * (i >> d & 1) for d in range(3))
             for i in range(8)], FACES)


def both(one, other):
    n = len(one[0])
    return (one[0] + other[0],
            one[1] + [[i + n for i in face] for face in other[1]])


def off(mesh):
    points, faces = mesh
    return "\n".join(["OFF", f"{len(points)} {len(faces)} 0",
                      *(" ".join(map(str, point)) for point in points),
                      *(" ".join(map(str, [len(face), *face])) for face in faces), ""])


def ascii_stl(mesh):
    points, faces = mesh
    lines = ["solid cube"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop",
                  *("vertex {} {} {}".format(*points[i]) for i in face), "endloop",
                  "endfacet"]
    return "\n".join([*lines, "endsolid cube", ""])


def binary_stl(mesh):
    """As text: the cube's coordinates, 0 and 32, have bytes below 128 only."""
    points, faces = mesh
    data = bytes(80) + struct.pack("<I", len(faces))
    for face in faces:
        data += struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in points[i]), 0)
    return data.decode("ascii")


def scaled(mesh, factor):
    return [tuple(factor * x for x in point) for point in mesh[0]], mesh[1]


def with_sliver():
    """The middle of an edge is a corner of one of its two triangles only; a triangle
    without area closes the gap."""
    points, faces = cube()
    faces = [face for face in faces if face != [0, 3, 1]]
    return points + [(16.0, 0.0, 0.0)], faces + [[3, 1, 8], [0, 3, 8], [1, 0, 8]]


BOX = cube()
POINTS = BOX[0]

# Name of a file, its text, what must be said about it.
BAD = {
    "open.off": (off((POINTS, FACES[:-1])),
                 r"open: the edge from \(32, 0, 0\) to \(32, 0, 32\) um.*holes"),
    "fin.off": (off((POINTS + [(50, 50, 50)], FACES + [[0, 1, 8]])),
                r"non-manifold: the edge from \(0, 0, 0\) to \(32, 0, 0\) um.*fins"),
    "wall-inside.off": (off(both(BOX, cube((32, 0, 0)))),
                        r"non-manifold: the edge from \(32, 0, 0\)"),
    "crossing.off": (off(both(BOX, cube(16.0))),
                     r"intersects .* 18 pairs of triangles .*\(16, 16, 16\)"),
    "touching.off": (off(both(BOX, cube(32.0))),
                     r"touches itself.*\(32, 32, 32\).*Repair"),
    "sliver.off": (off(with_sliver()), r"\(16, 0, 0\) um has no area"),
    "not-a-number.stl": (
        ascii_stl((["a b c".split()] + POINTS[1:], FACES)).replace("a b c", "nan 0 0"),
        r"Surface mesh.*(cannot be read|is at \(nan, 0, 0\))"),
    "missing-vertex.off": (off((POINTS, FACES + [[0, 1, 99]])), "cannot be read"),
    "empty.ply": ("", "file is empty"),
    "no-polygons.off": ("OFF\n0 0 0\n", r"Surface mesh.*(no polygons|read)"),
    "no-mesh.obj": ("once upon a time\n",
                    r"Surface mesh.*(no polygons|cannot be read)"),
    "cut-off.off": (off(BOX)[:-20], "cannot be read"),
    "cut-off-ascii.stl": (ascii_stl(BOX)[:-200], "cut off.*endsolid"),
    "cut-off-binary.stl": (binary_stl(BOX)[:400],
                           "cut off: it has 6 whole triangles, .* 12"),
    "in-metres.off": (off(scaled(BOX, 1e-6)), r"at least one .* 1e6 from m"),
    "in-nanometres.off": (off(scaled(BOX, 1e3 * 100)), "at most 25000 um long"),
    "beyond-numbers.off": (off(scaled(BOX, 1e200)), "is at .* in um"),
}

# Name of a file, its text, the volume inside.
GOOD = {
    "inverted.off": (off((POINTS, [face[::-1] for face in FACES])), 32**3),
    "half-inverted.off": (off((POINTS, [face[::1 if i % 3 else -1]
                                        for i, face in enumerate(FACES)])), 32**3),
    "loose-triangles.off": (off(([POINTS[i] for face in FACES for i in face],
                                 numpy.arange(36).reshape(12, 3).tolist())), 32**3),
    "point-faces.off": (off((POINTS, FACES + [[3, 3, 3]])), 32**3),
    "ascii.stl": (ascii_stl(BOX), 32**3),
    "binary.stl": (binary_stl(BOX), 32**3),
    "cavity.off": (off(both(cube(0.0, 48.0), cube(16.0, 16.0))), 48**3 - 16**3),
    # farther apart than splines reach
    "two-bodies.off": (off(both(BOX, cube((160, 0, 0)))), 2 * 32**3),
}


def run(case, file, text, **options):
    return case.trial(file, "mesh.prm", {"Tissue/Surface mesh": "{files}/" + file,
                                         "Solver/Newton tolerance": "1e-10"},
                      {file: text}, **options)


@pytest.mark.parametrize("file", BAD)
def test_defective(case, file):
    text, message = BAD[file]
    run(case, file, text, exits=(1,), message=message, row="defective")


@pytest.mark.parametrize("file", GOOD)
def test_odd_but_closed(case, file):
    """It grows to its exact volume."""
    text, volume = GOOD[file]
    results = run(case, file, text, row="odd but closed").results
    exact = 1.1**3 * volume
    surface = results.last_surface()
    inside = sum(numpy.sum(surface["area"] * surface["n" + x] * surface[x])
                 for x in "xyz") / 3
    case.found(f"{file}: volume inside, relative error", abs(inside / exact - 1),
               at_most=1e-9)
    case.found(f"{file}: volume of the cells, relative error",
               abs(results.last_cells()["volume"].sum() / exact - 1), at_most=1e-9)
