# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Obstacles that are none, and that the tissue is in."""
from tests.common.refusals.refusal import Refusal, wrong

WALL = "Obstacles/wall/"
OPEN = """OFF
4 3 0
0 0 0
64 0 0
0 64 0
0 0 64
3 0 2 1
3 0 1 3
3 0 3 2
"""
TWO = """OFF
8 8 0
0 0 0
64 0 0
0 64 0
0 0 64
8 8 -8
72 8 -8
8 72 -8
8 8 56
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
3 4 6 5
3 4 5 7
3 4 7 6
3 5 6 7
"""


def wall(name, key, value, limit, remedy, **keys):
    """A scene with one obstacle, a plane below the tissue but for the keys."""
    given = {WALL + "Shape": "plane", WALL + "Normal": "0, 0, 1",
             WALL + "Center": "0, 0, -200",
             **{WALL + short: text for short, text in keys.items()}}
    given.pop(key, None)
    return wrong(name, key, value, limit, remedy,
                 keys={"Obstacles/Names": "wall", **given})


OBSTACLES = [
    wrong("an obstacle twice", "Obstacles/Names", "wall, wall",
          "names that differ", "it is there twice"),
    wall("an unknown obstacle", WALL + "Shape", "torus",
         "plane, sphere, cylinder, box", "Correct the value"),
    wall("an obstacle without radius", WALL + "Radius", "0",
         "a length in um > 0, as Shape = sphere", "Give the radius",
         Shape="sphere"),
    wall("a mesh without file", WALL + "Surface mesh", "",
         "a file, as Shape = mesh", "Name the file", Shape="mesh"),
    wall("a mesh that is not there", WALL + "Surface mesh", "no/such/file.off",
         "a closed surface", "check that it exists", Shape="mesh"),
    Refusal("an obstacle's mesh that is open",
            {"Obstacles/Names": "wall", WALL + "Shape": "mesh",
             WALL + "Surface mesh": "{files}/open.off"},
            WALL + "Surface mesh", "{files}/open.off", "a closed surface",
            "The surface is open", {"open.off": OPEN}),
    Refusal("an obstacle's mesh that intersects itself",
            {"Obstacles/Names": "wall", WALL + "Shape": "mesh",
             WALL + "Surface mesh": "{files}/two.off"},
            WALL + "Surface mesh", "{files}/two.off", "a closed surface",
            "intersects or touches itself", {"two.off": TWO}),
    wall("a soft obstacle", WALL + "Stiffness", "0", "> 0, in units of E/h",
         "100 lets tissue"),
    wall("an obstacle that turns", WALL + "Velocity", "Y; 0; 0",
         "functions of t", "remove X, Y and Z"),
    wall("no side", WALL + "Side", "left", "outside, inside",
         "Correct the value"),
    Refusal("tissue in an obstacle",
            {"Obstacles/Names": "wall", WALL + "Shape": "plane",
             WALL + "Normal": "0, 0, -1"}, "Obstacles/Names", "'wall'",
            "at most half a grid spacing deep in at t = 0",
            "move the obstacle or the tissue, or correct Side"),
    wrong("an obstacle without its name", WALL + "Shape", "plane", "a key",
          "--parameters"),
]
