# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Free sphere and disc with smoothly graded growth, theta = 1 ... 1.4."""
from functools import partial

from tests.verification import growing_ball, layouts
from tests.verification.growing_ball import RADIUS
from tests.verification.ladder import Ladder, ladder_case, rungs, spacing
from tests.verification.radial import Layer

LAYERS = [Layer(0, RADIUS, lambda R: 1 + 0.4 * (R / RADIUS)**2,
                lambda R: 0.8 * R / RADIUS**2)]
DISC, SPHERE = ("graded-disc.prm",), ("graded-sphere.prm",)
SMOOTH = {"displacement": 1.9, "stress": 0.9}
TRIMMED = {"Tissue/Surface cells": "trimmed"}
STAIRCASE = {"displacement": 0.9, "stress": 0.9}
GROWN = {"Material/Energy per": "grown volume"}


def fitted(layout, ratio):
    """Cells of about h / ratio that fit the disc or ball."""
    return lambda h: partial(layout, RADIUS, h / ratio)


def sphere_at_50(convention, others):
    """The outer radius at h = 50 µm, in one step or several."""
    return Ladder(f"sphere-dt-{convention}", SPHERE, "dt [day]",
                  f"h = 50 µm, L_p = 10 µm, energy per {convention} volume",
                  rungs("Time/Step", [1, 0.5, 0.25, 0.125], others,
                        full_only=[0.5, 0.25, 0.125]),
                  most={"outer radius [µm]": 0.05},
                  label=f"graded sphere ({convention})")


CASE = ladder_case(
    title="Graded growth of a free sphere and a free disc",
    reference="two ordinary differential equations",
    errors=lambda results: growing_ball.errors(results, LAYERS),
    ladders=[
        Ladder("disc-h", DISC, "h [µm]", "h/L_p = 8, fitted cells, one step",
               rungs("Grid/Spacing", [80, 40, 20, 10], full_only=[10],
                     cells=fitted(layouts.disc, 8)),
               least_orders=SMOOTH,
               label="graded disc"),
        Ladder("disc-h-lattice", DISC, "h [µm]",
               "h/L_p = 8, cells on a lattice, one step",
               rungs("Grid/Spacing", [80, 40, 20, 10], spacing(8)),
               least_orders=STAIRCASE, full_only=True),
        Ladder("disc-h-trimmed", DISC, "h [µm]",
               "h/L_p = 8, trimmed cells on a lattice, one step",
               rungs("Grid/Spacing", [80, 40, 20, 10], spacing(8, **TRIMMED),
                     full_only=[10]),
               least_orders=SMOOTH,
               label="graded disc, trimmed lattice"),
        Ladder("disc-cells", DISC, "L_p [µm]",
               "h = 20 µm, fitted cells, one step",
               rungs("Tissue/Cell spacing", [10, 5, 2.5, 1.25],
                     {"Grid/Spacing": "20"},
                     cells=lambda L_p: partial(layouts.disc, RADIUS, L_p)),
               least_orders={"displacement": 1}, full_only=True,
               label="graded disc, fitted cells"),
        Ladder("disc-cells-lattice", DISC, "L_p [µm]",
               "h = 20 µm, cells on a lattice, one step",
               rungs("Tissue/Cell spacing", [10, 5, 2.5, 1.25],
                     {"Grid/Spacing": "20"}),
               least_orders=STAIRCASE, full_only=True,
               label="graded disc, lattice"),
        Ladder("sphere-h", SPHERE, "h [µm]",
               "h/L_p = 5, fitted cells, one step",
               rungs("Grid/Spacing", [100, 70, 50],
                     cells=fitted(layouts.ball, 5)),
               least_orders=SMOOTH,
               label="graded sphere"),
        Ladder("sphere-h-lattice", SPHERE, "h [µm]",
               "h/L_p = 5, cells on a lattice, one step",
               rungs("Grid/Spacing", [100, 70, 50, 40], spacing(5)),
               least_orders=STAIRCASE, full_only=True),
        Ladder("sphere-h-trimmed", SPHERE, "h [µm]",
               "h/L_p = 5, trimmed cells on a lattice, one step",
               rungs("Grid/Spacing", [100, 70, 50, 40], spacing(5, **TRIMMED)),
               least_orders=SMOOTH, full_only=True),
        sphere_at_50("initial", {}),
        sphere_at_50("grown", GROWN),
    ])
