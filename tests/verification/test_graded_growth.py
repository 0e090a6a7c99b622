# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Free sphere and disc with smoothly graded growth, theta = 1 ... 1.4."""
from tests.verification import growing_ball, layouts
from tests.verification.growing_ball import RADIUS
from tests.verification.ladder import Ladder, ladders, spacing
from tests.verification.radial import Layer

LAYERS = [Layer(0, RADIUS, lambda R: 1 + 0.4 * (R / RADIUS)**2,
                lambda R: 0.8 * R / RADIUS**2)]
DISC, SPHERE = ("graded-disc.prm",), ("graded-sphere.prm",)
SMOOTH = {"displacement": 1.9, "stress": 0.9}
TRIMMED = {"Tissue/Surface cells": "trimmed"}
STAIRCASE = {"displacement": 0.9, "stress": 0.9}
AT_50 = "h = 50 µm, L_p = 10 µm"


def fitted(layout, ratio):
    """Cells of about h / ratio that fit the disc or ball."""
    return lambda h: layout(RADIUS, h / ratio)


@ladders(
    Ladder("disc-h", DISC, "Grid/Spacing", "h/L_p = 8, fitted cells, one step",
           [80, 40, 20, 10], cells=fitted(layouts.disc, 8),
           few=(80, 40), least_orders=SMOOTH),
    Ladder("disc-h-lattice", DISC, "Grid/Spacing",
           "h/L_p = 8, cells on a lattice, one step", [80, 40, 20, 10], spacing(8),
           least_orders=STAIRCASE),
    Ladder("disc-h-trimmed", DISC, "Grid/Spacing",
           "h/L_p = 8, trimmed cells on a lattice, one step", [80, 40, 20, 10],
           spacing(8, **TRIMMED), few=(80, 40), least_orders=SMOOTH),
    Ladder("disc-cells", DISC, "Tissue/Cell spacing", "h = 20 µm, fitted cells, one step",
           [10, 5, 2.5, 1.25], {"Grid/Spacing": "20"},
           cells=lambda L_p: layouts.disc(RADIUS, L_p),
           least_orders={"displacement": 1}),
    Ladder("disc-cells-lattice", DISC, "Tissue/Cell spacing",
           "h = 20 µm, cells on a lattice, one step", [10, 5, 2.5, 1.25],
           {"Grid/Spacing": "20"}, least_orders=STAIRCASE),
    Ladder("sphere-h", SPHERE, "Grid/Spacing", "h/L_p = 5, fitted cells, one step",
           [100, 70, 50], cells=fitted(layouts.ball, 5),
           least_orders=SMOOTH),
    Ladder("sphere-h-lattice", SPHERE, "Grid/Spacing",
           "h/L_p = 5, cells on a lattice, one step", [100, 70, 50, 40], spacing(5),
           least_orders=STAIRCASE),
    Ladder("sphere-h-trimmed", SPHERE, "Grid/Spacing",
           "h/L_p = 5, trimmed cells on a lattice, one step", [100, 70, 50, 40],
           spacing(5, **TRIMMED), least_orders=SMOOTH),
    # The outer radius, in one step or several.
    Ladder("sphere-dt-initial", SPHERE, "Time/Step", AT_50, [1, 0.5, 0.25, 0.125],
           few=(1,), most={"outer radius [µm]": 0.05}),
    Ladder("sphere-dt-grown", SPHERE, "Time/Step", AT_50 + ", energy per grown volume",
           [1, 0.5, 0.25, 0.125], {"Material/Energy per": "grown volume"},
           most={"outer radius [µm]": 0.05}))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: growing_ball.errors(results, LAYERS))
