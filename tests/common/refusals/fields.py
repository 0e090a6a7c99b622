# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fields with numbers, names or keys that they cannot have."""
from tests.common.refusals.expressions import PLANE
from tests.common.refusals.refusal import CYCLE, wrong

OXYGEN = "Fields/oxygen/"
FIELD = {"Fields/Names": "oxygen", OXYGEN + "Diffusion": "1e8",
         OXYGEN + "Consumption": "4e4"}


def wrong_field(name, key, value, limit, remedy, **others):
    """A key of the field oxygen."""
    keys = {**FIELD, **others}
    keys.pop(OXYGEN + key, None)
    return wrong(name, OXYGEN + key, value, limit, remedy, keys=keys)


FIELDS = [
    *(wrong_field(name, "Diffusion", value, "a value > 0 um^2/day",
                  "Oxygen has about 1.7e8")
      for name, value in (("no diffusion", "0"),
                          ("no diffusion at some founder", "X"))),
    wrong_field("a field that does not say how it diffuses", "Diffusion", "",
                "an expression > 0 um^2/day", "Each field needs one"),
    *(wrong_field(name, "Consumption", value, "a value >= 0 1/day",
                  "What a cell makes is Production")
      for name, value in (("negative consumption", "-1"),
                          ("negative consumption at some founder", "X"),
                          ("negative consumption of what is there",
                           "oxygen - 1"))),
    wrong_field("negative production", "Production", "-1",
                "a value >= 0 a day", "What a cell uses up is Consumption"),
    wrong_field("negative transfer", "Transfer", "-1", "a value >= 0 um/day",
                "0 lets nothing pass"),
    wrong_field("negative transfer somewhere", "Transfer", "X",
                "a value >= 0 um/day", "0 lets nothing pass"),
    wrong_field("negative flux somewhere", "Flux", "X",
                "a value >= 0 um/day", "What leaves the tissue does so by",
                **{OXYGEN + "Flux where": "1"}),
    wrong_field("a flux nowhere", "Flux", "1",
                "nothing, as Fields/oxygen/Flux where is empty",
                "Set both of them, or none"),
    wrong_field("no flux somewhere", "Flux where", "1",
                "nothing, as Fields/oxygen/Flux is empty",
                "Set both of them, or none"),
    wrong_field("a flux only where the field is fixed", "Flux where", "X > 0",
                "a condition that holds at some boundary point",
                "correct it, or leave it empty",
                **{OXYGEN + "Flux": "1", OXYGEN + "Fixed where": "1"}),
    wrong_field("a steady field with a flux and without level", "Consumption",
                "0", "a rate > 0 1/day for a steady field",
                "Without a sink any constant could be added to the field",
                **{OXYGEN + "Flux": "1", OXYGEN + "Flux where": "1"}),
    wrong_field("negative value somewhere", "Value", "X",
                "a value >= 0 (a concentration)", "0 is none at all",
                **{OXYGEN + "Fixed where": "1"}),
    wrong_field("negative at the start", "Initial", "X",
                "a value >= 0 (a concentration)", "0 is none at all"),
    wrong_field("a value nowhere", "Value", "160",
                "its default, as neither Fields/oxygen/Fixed where nor "
                "Fields/oxygen/Transfer is set", "or remove this key"),
    wrong_field("a field fixed nowhere", "Fixed where", "X > 1000",
                "a condition that holds at some boundary point",
                "correct it, or leave it empty"),
    wrong_field("a steady field without level", "Consumption", "0",
                "a rate > 0 1/day for a steady field",
                "Without a sink any constant could be added to the field"),
    wrong_field("a field of another state", "Time", "stationary",
                "any one of steady, transient", "Correct the value"),
    wrong_field("a field before there are cells", "Initial", "x",
                "an expression that muParser understands",
                "Write X, the initial position."),
    wrong_field("a field in 2-D that reads Z", "Consumption", "Z > 0",
                "an expression without Z in 2-D", "write it with X and Y",
                **PLANE),
    *(wrong(name, "Fields/Names", value, "names that differ", remedy)
      for name, value, remedy in (
          ("a field of a variable's name", "pressure",
           "Expressions have a variable or function of this name"),
          ("a field of a capital name", "Oxygen",
           "Names of fields have small letters"),
          ("a field twice", "oxygen, oxygen", "it is there twice"))),
    wrong("a field of a column's name", "Fields/Names", "phase",
          "names that no other column of cells-NNNN.csv and snapshot.h5 has",
          "Choose another name", keys={"Fields/phase/Diffusion": "1",
                                       "Fields/phase/Consumption": "1"}),
    wrong("more fields than there can be", "Fields/Names",
          ", ".join(f"f{i}" for i in range(33)), "at most 32 names",
          "There are 33"),
    wrong("a type of a field's name", "Cell types/Names", "oxygen",
          "names that differ", "A field has this name: choose another one",
          keys=FIELD),
    wrong("a gradient of no field", "Contraction/Direction",
          "gradient of sugar", "the gradient of a field of the scene",
          "There is no field 'sugar': name it in Fields/Names",
          keys={**FIELD, "Contraction/Stretch": "0.9"}),
    wrong("divisions along a gradient of no field", CYCLE + "Division axis",
          "gradient of sugar", "gradient of oxygen",
          "Did you mean 'gradient of oxygen'?", keys=FIELD),
    wrong("an expression with an unknown field", CYCLE + "G0 exit rate",
          "hill(oxigen, 20, 2)", "an expression that muParser understands",
          "oxygen, components are separated by ';'", keys=FIELD),
    wrong("stiffness by a field", "Material/Young's modulus", "1 + oxygen",
          "an expression that muParser understands", "The variables are X",
          keys=FIELD),
]
