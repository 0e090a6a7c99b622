# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Types of cells with names, keys or rates that they cannot have, and what
expressions of the cell's state may not say."""
from tests.common.refusals.refusal import CYCLE, wrong

TYPES = {"Cell types/Names": "stem, leaf"}
STEM = "Cell types/stem/"
LEAVE = STEM + "Transitions/To leaf"
UNREADABLE = "an expression that muParser understands"
NAMES = "names that differ, separated by commas"


def wrong_type(name, key, value, limit, remedy):
    return wrong(name, key, value, limit, remedy, keys=TYPES)


CELL_TYPES = [
    *(wrong(name, "Cell types/Names", value, NAMES, remedy)
      for name, value, remedy in (
          ("a type twice", "stem, stem", "'stem': it is there twice"),
          ("a type named like a variable", "stem, pressure",
           "'pressure': Expressions have a variable or function of this name"),
          ("a type named like a function", "stem, hill",
           "'hill': Expressions have a variable or function of this name"),
          ("a type named like a number", "stem, 2x",
           "Names have letters, digits and '_', and begin with a letter"))),
    wrong("a type named like a field", "Cell types/Names", "stem, oxygen", NAMES,
          "choose another one", keys={"Fields/Names": "oxygen",
                                      "Fields/oxygen/Diffusion": "1e8"}),
    wrong_type("a type that is not there", LEAVE, "type == leave", UNREADABLE,
               'character 9: Unexpected token "leave". If it is a field, '
               "Fields/Names must have it; functions are those of muParser, "
               "with ramp, hill and if. The variables are X, Y, Z, t, x, y, z, "
               "generation"),
    wrong_type("a transition to itself", STEM + "Transitions/To stem", "1",
               "a key that exists",
               "That name stands in subsection Cell types/leaf/Transitions"),
    wrong_type("a transition to nowhere", STEM + "Transitions/To root", "1",
               "a key that exists", f"Did you mean '{LEAVE}'"),
    *(wrong_type(name, LEAVE, value, ">= 0 1/day",
                 "0 lets cells keep their type")
      for name, value in (("a negative transition", "-1"),
                          ("a transition that is negative at some founder", "X"),
                          ("a transition that is negative without pressure",
                           "pressure - 1"))),
    wrong_type("a transition without a value", LEAVE, "log(J_e - 2)",
               "a finite value", "Change the expression so that it is finite"),
    wrong_type("founders by where they are now", STEM + "Where", "y > 0",
               UNREADABLE, "Write Y, the initial position"),
    wrong_type("one daughter", STEM + "Daughter types", "leaf",
               "two of stem, leaf", "Name the types of both daughters"),
    wrong_type("a daughter of no type", STEM + "Daughter types", "leaf, root",
               "two of stem, leaf", "There is no type 'root'"),
    wrong_type("keys of a type that is not there", "Cell types/root/Where", "1",
               "a section that exists", "Did you mean 'Cell types/stem/Where'"),
    wrong_type("a type within a type", STEM + "Cell types/leaf/Where", "1",
               "a section that exists", "That name stands in subsection"),
    wrong_type("a type with a grid of its own", STEM + "Grid/Spacing", "1",
               "a section that exists", "Did you mean 'Grid/Spacing'"),
    wrong_type("an unknown axis of a type", STEM + CYCLE + "Division axis",
               "upwards", "random, fixed, stretch", "Correct the value"),
    wrong_type("an unknown fate of the stress", "Material/On transition", "keep",
               "any one of keep strain, forget stress", "Correct the value"),
    wrong_type("a stiffness by stress", STEM + "Material/Young's modulus",
               "1 + pressure", UNREADABLE, "This key has no pressure"),
    wrong_type("powers as elsewhere", STEM + CYCLE + "Duration", "1 + x**2",
               "1 expression", "Write '^' for powers"),
    wrong("where cells are now in a place", CYCLE + "Where", "z > 40",
          UNREADABLE, "Write Z, the initial position"),
]
