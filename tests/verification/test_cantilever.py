# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A cantilever bent by its own weight."""
from functools import lru_cache

from tests.verification import block
from tests.verification.finite_elements import Axis, Block
from tests.verification.ladder import Ladder, ladders, spacing, spacing_and_cut
from tests.verification.material import lame

PLANE, SPACE = ("cantilever-2d.prm",), ("cantilever-3d.prm",)
SMOOTH = {"displacement": 1.9, "stress": 0.9}


@lru_cache(maxsize=None)
def reference():
    """Elements refined towards the clamped corners."""
    return block.converged(lambda degree: Block(
        (Axis([0, 2, 8, 24, 60, 120, 200], degree),
         Axis([0, 2, 8, 25, 42, 48, 50], degree)),
        lame(nu=0), (0, -4e-5), {"left": lambda factor: (0, 0)}))


@ladders(
    Ladder("2d-h", PLANE, "Grid/Spacing", "h/L_p = 6, one step", [12.5, 6.25, 3.125],
           spacing(6), few=(12.5, 6.25), least_orders=SMOOTH),
    Ladder("2d-h-cut", PLANE, "Grid/Spacing", "h/L_p = 6, cut grid, one step",
           [25, 12.5, 6.25, 3.125], spacing_and_cut(6), least_orders=SMOOTH),
    Ladder("2d-h-fixed-cells", PLANE, "Grid/Spacing", "L_p = 0.390625 µm, one step",
           [25, 12.5, 6.25, 3.125], {"Tissue/Cell spacing": "0.390625"},
           least_orders={"stress": 0.9}),
    Ladder("2d-cells", PLANE, "Tissue/Cell spacing", "h = 12.5 µm, one step",
           [6.25, 3.125, 1.5625, 0.78125],
           least_orders={"displacement": 1.9}),
    Ladder("2d-dt", PLANE, "Time/Step", "h = 12.5 µm, L_p = 1.5625 µm",
           [1, 0.5, 0.25, 0.125, 0.0625],
           most={"displacement": 1e-3, "stress": 1.5e-2}),
    Ladder("3d-h", SPACE, "Grid/Spacing", "h/L_p = 6, one step", [12.5, 6.25],
           spacing(6), least_orders=SMOOTH))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: block.errors(results, reference()))
