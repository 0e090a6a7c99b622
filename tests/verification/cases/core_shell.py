# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Free sphere and disc of which only the core grows."""
from functools import partial

from tests.verification import growing_ball, layouts
from tests.verification.growing_ball import RADIUS
from tests.verification.ladder import Ladder, ladder_case, rungs, spacing
from tests.verification.radial import Layer

CORE = RADIUS / 2
LAYERS = [Layer(0, CORE, lambda R: 1.4 + 0 * R, lambda R: 0.0),
          Layer(CORE, RADIUS, lambda R: 1.0 + 0 * R, lambda R: 0.0)]
DISC, SPHERE = ("core-shell-disc.prm",), ("core-shell-sphere.prm",)
# F is continuous where F_e jumps: no smooth field can be right on both sides.
JUMP = {"displacement": 1.1, "stress": 0.4}

CASE = ladder_case(
    title="Core and shell: growth that jumps",
    reference="two ordinary differential equations",
    errors=lambda results: growing_ball.errors(results, LAYERS),
    ladders=[
        Ladder("disc-h", DISC, "h [µm]", "h/L_p = 8, one step",
               rungs("Grid/Spacing", [80, 40, 20, 10], spacing(8),
                     full_only=[10]),
               least_orders=JUMP, label="core and shell, disc"),
        Ladder("disc-h-fitted", DISC, "h [µm]",
               "h/L_p = 8, fitted cells, one step",
               rungs("Grid/Spacing", [80, 40, 20, 10],
                     cells=lambda h: partial(layouts.disc, RADIUS, h / 8)),
               least_orders=JUMP, full_only=True),
        Ladder("sphere-h", SPHERE, "h [µm]", "h/L_p = 5, one step",
               rungs("Grid/Spacing", [100, 50, 35], spacing(5),
                     full_only=[35]),
               least_orders=JUMP, label="core and shell, sphere"),
    ])
