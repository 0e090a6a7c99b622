# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Free sphere and disc of which only the core grows."""
from tests.verification import growing_ball, layouts
from tests.verification.growing_ball import RADIUS
from tests.verification.ladder import Ladder, ladders, spacing
from tests.verification.radial import Layer

CORE = RADIUS / 2
LAYERS = [Layer(0, CORE, lambda R: 1.4 + 0 * R, lambda R: 0.0),
          Layer(CORE, RADIUS, lambda R: 1.0 + 0 * R, lambda R: 0.0)]
DISC, SPHERE = ("core-shell-disc.prm",), ("core-shell-sphere.prm",)
# F is continuous where F_e jumps: no smooth field can be right on both sides.
JUMP = {"displacement": 1.1, "stress": 0.4}


@ladders(
    Ladder("disc-h", DISC, "Grid/Spacing", "h/L_p = 8, one step", [80, 40, 20, 10],
           spacing(8), few=(80, 20), least_orders=JUMP),
    Ladder("disc-h-fitted", DISC, "Grid/Spacing", "h/L_p = 8, fitted cells, one step",
           [80, 40, 20, 10], cells=lambda h: layouts.disc(RADIUS, h / 8),
           least_orders=JUMP),
    Ladder("sphere-h", SPHERE, "Grid/Spacing", "h/L_p = 5, one step", [100, 50, 35],
           spacing(5), least_orders=JUMP))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: growing_ball.errors(results, LAYERS))
