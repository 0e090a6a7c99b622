# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Lumens that no surface encloses, or whose content is not said."""
from tests.common.refusals.refusal import CONDITIONS, wrong

WHERE = CONDITIONS + "Lumen where"
VOLUME = CONDITIONS + "Lumen volume"
PRESSURE = CONDITIONS + "Lumen pressure"
SHELL = {"Tissue/Shape": "sphere", "Tissue/Radius": "40",
         "Tissue/Inner radius": "20", VOLUME: "1"}
INSIDE = {WHERE: "X^2 + Y^2 + (Z - 30)^2 < 30^2"}

LUMENS = [
    wrong("a shell without inside", "Tissue/Inner radius", "50",
          "less than Tissue/Radius", "what lies between the two",
          keys={"Tissue/Shape": "sphere", "Tissue/Radius": "40"}),
    wrong("a negative cavity", "Tissue/Inner radius", "-1", "a length >= 0 um",
          "what lies between the two",
          keys={"Tissue/Shape": "sphere", "Tissue/Radius": "40"}),
    wrong("a cavity of no size", "Tissue/Inner radius", "1e-300",
          "0 for no cavity, or a length in um", "No cell could notice",
          keys={"Tissue/Shape": "sphere", "Tissue/Radius": "40"}),
    wrong("a lumen without volume", VOLUME, "",
          "a function of t where Boundary conditions/Lumen where is set",
          "1 keeps the volume", keys={WHERE: "1"}),
    wrong("a volume of no lumen", VOLUME, "1 + t",
          "its default, as Boundary conditions/Lumen where is not set",
          "Say where it acts"),
    wrong("a lumen with volume and pressure", PRESSURE, "1",
          "nothing where Boundary conditions/Lumen volume is set",
          "leave one of them empty", keys={**SHELL, **INSIDE}),
    wrong("a lumen of no volume", VOLUME, "0",
          "a value > 0 times the volume at t = 0", "1 keeps the volume",
          keys=INSIDE),
    wrong("a lumen that vanishes", VOLUME, "1 - t",
          "a value > 0 times the volume at t = 0", "at t = 1 day",
          keys={key: value for key, value in {**SHELL, **INSIDE}.items()
                if key != VOLUME}),
    wrong("a lumen that is not the same everywhere", VOLUME, "1 + X",
          "a function of t", "remove X, Y and Z", keys=INSIDE),
    wrong("a lumen that is open", WHERE, "Z > 30 && X^2 + Y^2 + (Z - 30)^2 < 900",
          "a condition that chooses a closed surface", "It is open", keys=SHELL),
    wrong("a lumen of the outer surface", WHERE, "1",
          "a condition that chooses the surface of a lumen",
          "whose normals point into the lumen", keys=SHELL),
    wrong("a lumen of no surface", WHERE, "X > 900",
          "a condition that holds at some boundary point", "or leave it empty",
          keys=SHELL),
]
