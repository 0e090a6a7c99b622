# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Nitsche's conditions against a mesh that fits the body."""
from functools import lru_cache

from tests.verification import block
from tests.verification.finite_elements import Axis, Block
from tests.verification.ladder import Ladder, cut, ladders, spacing, spacing_and_cut
from tests.verification.material import lame

PLANE, SPACE = ("fitted-2d.prm",), ("fitted-3d.prm",)
SMOOTH = {"displacement": 1.9, "stress": 0.9}
PENALTY_30 = {"Boundary conditions/Nitsche penalty": "30"}
UNSYMMETRIC = {"Boundary conditions/Nitsche form": "unsymmetric",
               "Boundary conditions/Nitsche penalty": "20"}


@lru_cache(maxsize=None)
def reference():
    """Elements refined towards the corners."""
    edges = [0, 2, 8, 25, 50, 75, 92, 98, 100]
    return block.converged(lambda degree: Block(
        (Axis(edges, degree), Axis(edges, degree)), lame(nu=0),
        held={"bottom": lambda factor: (0, 0),
              "top": lambda factor: (20 * factor, -10 * factor)}))


@ladders(
    Ladder("2d-h", PLANE, "Grid/Spacing", "h/L_p = 8, one step", [25, 12.5, 6.25, 3.125],
           spacing(8), least_orders=SMOOTH),
    Ladder("2d-h-cut", PLANE, "Grid/Spacing", "h/L_p = 8, cut grid, one step",
           [25, 12.5, 6.25, 3.125], spacing_and_cut(8), least_orders=SMOOTH),
    Ladder("2d-h-cut-penalty-30", PLANE, "Grid/Spacing",
           "h/L_p = 8, cut grid, penalty 30 E/h, one step", [25, 12.5, 6.25, 3.125],
           spacing_and_cut(8, **PENALTY_30), least_orders=SMOOTH),
    Ladder("2d-h-cut-unsymmetric", PLANE, "Grid/Spacing",
           "h/L_p = 8, cut grid, unsymmetric form, penalty 20 E/h, one step",
           [25, 12.5, 6.25, 3.125], spacing_and_cut(8, **UNSYMMETRIC), least_orders=SMOOTH),
    Ladder("2d-cells-cut", PLANE, "Tissue/Cell spacing", "h = 6.25 µm, cut grid, one step",
           [3.125, 1.5625, 0.78125, 0.390625],
           lambda L_p: {"Grid/Spacing": "6.25", **cut(6.25, L_p)},
           most={"displacement": 1e-3, "stress": 0.02}),
    Ladder("2d-dt", PLANE, "Time/Step", "h = 6.25 µm, L_p = 0.78125 µm",
           [1, 0.5, 0.25, 0.125],
           {"Grid/Spacing": "6.25", "Tissue/Cell spacing": "0.78125"},
           most={"displacement": 5e-4, "stress": 1e-2}),
    Ladder("3d-h-cut", SPACE, "Grid/Spacing", "h/L_p = 5, cut grid, one step",
           [25, 12.5, 6.25], spacing_and_cut(5), least_orders=SMOOTH))
def test_ladder(case, ladder):
    ladder.climb(case, lambda results: block.errors(results, reference()))
