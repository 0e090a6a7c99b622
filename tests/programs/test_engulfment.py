# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Halves of a ball, of two types, by tension and exchange of places together: the
spreading coefficients say whether one engulfs the other, both share an interface, or
they part; the same on several ranks and after a resumption."""
import numpy
import pytest
from scipy.spatial import cKDTree

from tests.common.program import assert_same_file

SCENE = {"Time/End time": 1.5, "Time/Step": 0.05,
         "Material/Relaxation time": 0.05,
         "Cell types/Names": "A, B",
         "Cell types/A/Tension/With surface": 2, "Cell types/B/Where": "X > 0",
         "Rearrangement/Diffusion": 100, "Output/Formats": "csv", "Output/Interval": 0.5}
SIZES = {2: {"Dimension": 2, "Tissue/Radius": 70, "Tissue/Cell spacing": 5,
             "Grid/Spacing": 15, "Grid/Offset": "3, 7", "Rearrangement/Fluctuation energy": 6},
         3: {"Tissue/Radius": 50, "Tissue/Cell spacing": 9, "Grid/Spacing": 25,
             "Grid/Offset": "3, 7, 1", "Rearrangement/Fluctuation energy": 60}}
# By the tensions of B's surface and of the interface, with 2 of A's surface: A
# spreads on B if B's surface costs more than A's and the interface together; they
# part if the interface costs more than both surfaces.
ENGULF, SHARE, PART = (4, 1), (2, 2), (2, 6)


def keys_of(dim, case):
    of_b, between = case
    return {**SCENE, **SIZES[dim], "Cell types/B/Tension/With surface": of_b,
            "Cell types/B/Tension/With A": between}


def state(run):
    """A's share of the surface at the end, and the distance of the centres, radii."""
    cells, surface = run.cells(3), run.surface(3)
    X = cells[["x", "y", "z"]].to_numpy()
    nearest = cKDTree(X).query(surface[["x", "y", "z"]])[1]
    kind, area = cells["type"].to_numpy(), surface["area"]
    centers = [X[kind == k].mean(0) for k in (0, 1)]
    return (area[kind[nearest] == 0].sum() / area.sum(),
            numpy.linalg.norm(centers[1] - centers[0]) / run.number("Tissue/Radius"))


@pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.release)])
def test_order_by_the_three_tensions(runs, dim):
    run = {case: runs.run(f"{dim}-{case[0]}-{case[1]}", keys_of(dim, case))
           for case in (ENGULF, SHARE, PART)}
    found = {case: state(run[case]) for case in run}
    print(dim, found)
    # Halves of a ball: 0.5; balls of half the size that touch: 1.41 and
    # 1.59 radii from centre to centre.
    assert found[ENGULF][0] > 0.65
    assert abs(found[SHARE][0] - 0.5) <= 0.03
    assert abs(found[PART][0] - 0.5) <= 0.03
    assert found[ENGULF][1] < found[SHARE][1] - 0.15
    assert found[SHARE][1] < found[PART][1] - 0.3
    assert found[PART][1] > 1.41
    if dim == 2:
        # The flow over the core draws cells out and together; without their
        # spreading 5 % of them would be nearer than half a spacing to another.
        cells = run[ENGULF].cells(3)
        X = cells[["x", "y"]]
        nearest = cKDTree(X).query(X, 2)[0][:, 1] / numpy.sqrt(cells["volume"].mean())
        assert numpy.percentile(nearest, 5) > 0.55


def test_ranks_and_resumption(runs):
    # Ranks differ by what Newton's method leaves.
    keys = {**keys_of(2, ENGULF), "Time/End time": 0.5, "Output/Interval": 0.25,
            "Solver/Newton tolerance": 1e-10}
    one, three = (runs.run(f"on-{ranks}", keys, ranks=ranks) for ranks in (1, 3))
    for column in ("id", "type", "x", "y"):
        numpy.testing.assert_allclose(one.cells(2)[column], three.cells(2)[column], rtol=0,
                                      atol=1e-7 if column in "xy" else 0)
    parts = runs.resumed("parts", keys, {}, 0.25)
    assert_same_file(one.directory / "cells-0002.csv", parts.directory / "cells-0002.csv")
