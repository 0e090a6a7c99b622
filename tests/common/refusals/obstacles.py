# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Obstacles that are none, and that the tissue is in."""
from tests.common.refusals.refusal import Refusal, wrong

WALL = "Obstacles/wall/"


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
