# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Expressions that cannot be read, or whose values a key cannot have."""
from tests.common.refusals.refusal import CONDITIONS, CYCLE, wrong

EXPRESSIONS = [
    wrong("stiffness negative somewhere", "Material/Young's modulus", "X",
          "> 0 kPa", "It is -24 kPa at (-24 -24 6) um. Make it positive"),
    wrong("unknown variable", "Growth/Isotropic/Stretch", "1 + 0.1*tt",
          "an expression that muParser understands",
          'character 9: Unexpected token "tt". If it is a field, Fields/Names '
          "must have it; functions are those of muParser, with ramp, hill and "
          "if. The variables are X, Y, Z, t, x, y, z, generation, age", keys={"Growth/Law": "isotropic"}),
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
    wrong("friction that becomes negative", "Friction/Coefficient",
          "1e-5*(0.5 - t)", "a value >= 0 kPa day/um^2", "0 is no friction"),
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
    without_z(CONDITIONS + "Surface tension", "Z"),
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
    wrong("a stress that cells wither for", "Growth/Rate/Homeostatic stress",
          "1e6", "a rate that leaves cells between 1e-6 and 1e300",
          "Let the rate end", keys={**RATE, "Growth/Rate/Homeostasis": "1"}),
    wrong("a rate without value", "Growth/Rate/Rate", "log(J_e - 1)",
          "a finite value", "t = ", keys=RATE),
    wrong("homeostasis that flees its stress", "Growth/Rate/Homeostasis", "-1",
          "a value >= 0 1/(day kPa)", "0 is no growth by stress", keys=RATE),
]
