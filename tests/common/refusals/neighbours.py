# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Neighbours, tensions between types and exchanges of places that cannot be."""
from tests.common.refusals.refusal import wrong

TYPES = {"Cell types/Names": "stem, leaf"}
LEAVE = "Cell types/stem/Transitions/To leaf"
WITH = "Cell types/stem/Tension/With leaf"
POOLED = {"Material/Volumetric strain": "pooled",
          "Material/Energy per": "grown volume"}
DIFFUSION = {"Rearrangement/Diffusion": "10"}


def wrong_type(name, key, value, limit, remedy, **more):
    return wrong(name, key, value, limit, remedy, keys={**TYPES, **more})


NEIGHBOURS = [
    *(wrong_type(name, LEAVE, value, "a variable that there is", remedy)
      for name, value, remedy in (
          ("neighbours of no type", "neighbours_root > 1",
           "'neighbours_root' ends with no name that it can be of. Types: stem, "
           "leaf"),
          ("the slope of no field", "slope_oxygen", "fields: none"),
          ("a mean of nothing", "around_nothing", "around_ is followed by"),
          ("a mean of a mean", "around_around_pressure",
           "around_ is followed by"))),
    wrong_type("stiffness by the neighbours", "Material/Young's modulus",
               "1 + neighbours", "an expression without 'neighbours'",
               "let cells change their type by it"),
    wrong("a search without reach", "Neighbours/Reach", "0",
          "a value > 0, at most 2.5", "Cells that far apart do not touch"),
    wrong("a search by chance", "Neighbours/Found by", "chance", "facets",
          "radius"),
    wrong_type("two tensions of one interface",
               "Cell types/leaf/Tension/With stem", "2",
               "the value of " + WITH + ", 1 kPa um",
               "An interface has one tension: remove one of the two keys",
               **{WITH: "1"}),
    wrong_type("an interface that pushes", WITH, "-1", "a value >= 0 kPa um",
               "set Tension/Force = false"),
    wrong_type("a surface that pushes", "Cell types/stem/Tension/With surface",
               "-1", "a value >= 0 kPa um", "set Tension/Force = false"),
    wrong_type("a tension with itself", "Cell types/stem/Tension/With stem",
               "1", "a key that exists", ""),
    wrong_type("two tensions of the surface",
               "Boundary conditions/Surface tension", "1",
               "its default, as types of cells have tensions",
               "Remove this key",
               **{"Cell types/stem/Tension/With surface": "1"}),
    wrong("exchange without diffusion", "Rearrangement/Fluctuation energy", "1",
          "its default, as Rearrangement/Diffusion is not set",
          "Set Rearrangement/Diffusion > 0"),
    wrong("negative diffusion of cells", "Rearrangement/Diffusion", "-1",
          ">= 0 um^2/day", "0 lets the cell keep its place", keys=POOLED),
    wrong("more shear than there is", "Rearrangement/Shear released", "1.5",
          "a number from 0 to 1", "1 releases all shear",
          keys={**POOLED, **DIFFUSION}),
    wrong("a drive without fluctuations", "Rearrangement/Fluctuation energy",
          "0", "a value > 0, as Rearrangement/Drive is set",
          "A drive is followed at the rate D f/T",
          keys={**POOLED, **DIFFUSION, "Rearrangement/Drive": "1; 0; 0"}),
    wrong("exchange of cells that grow each for itself",
          "Material/Volumetric strain", "projected", "pooled, as "
          "Rearrangement/Diffusion is set", "A place keeps its space",
          keys=DIFFUSION),
    wrong("exchange of cells of several points", "Grid/Points per cell", "2",
          "1, as Rearrangement/Diffusion is set", "several points",
          keys={**POOLED, **DIFFUSION}),
    wrong("exchange by radius", "Neighbours/Found by", "radius",
          "facets, as Rearrangement/Diffusion is set",
          "The rates of exchange follow from the facets",
          keys={**POOLED, **DIFFUSION}),
]
