# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fields that come in at fixed values, wherever the grid lines lie: what is in
a slab is l tanh(L/l)/L of the value, l the root of diffusion over uptake."""
import math

import pytest

H, LENGTH = 20, 160
OFFSETS = (0, 5, 10, 15)
SCENE = {"Tissue/Shape": "box", "Grid/Spacing": H, "Time/End time": 0.1, "Time/Step": 0.1,
         "Output/Formats": "none", "Fields/Names": "u", "Fields/u/Diffusion": 1000,
         "Fields/u/Fixed where": "X > 79.9", "Fields/u/Value": 1}


def ratio(runs, reach, offset, dim=2, cell=5):
    """What is in the slab to what shall be, and what is said."""
    edges, offsets = (LENGTH, 40, 20)[:dim], (offset, 3, 7)[:dim]
    layer = reach * H
    run = runs.run("slab", SCENE, {
        "Dimension": dim, "Tissue/Size": str(edges)[1:-1], "Tissue/Cell spacing": cell,
        "Grid/Offset": str(offsets)[1:-1], "Fields/u/Consumption": 1000 / layer**2})
    mean = run.statistics["u_mean"].iloc[-1]
    return mean / (layer / LENGTH * math.tanh(LENGTH / layer)), run.said


@pytest.mark.parametrize("dim, reach, allowed", [
    (2, 0.5, 0.03), (2, 1, 0.01), (2, 2, 0.003), (2, 5, 0.001), (3, 1, 0.01)])
def test_layers_that_the_grid_resolves(runs, dim, reach, allowed):
    for offset in OFFSETS:
        found, said = ratio(runs, reach, offset, dim)
        assert abs(found - 1) <= allowed, offset
        assert "the field reaches only" not in said


@pytest.mark.parametrize("reach", [0.15, 0.22, 0.35, 0.45])
def test_layers_that_it_does_not_resolve(runs, reach):
    """The word names the error at the worst offset."""
    ratios = []
    for offset in (*OFFSETS, 2.5):
        found, said = ratio(runs, reach, offset, cell=2.5)
        ratios.append(found)
        assert "less than half a grid spacing" in said
    may_be = float(said.split("may be too much by ")[1].split()[0])
    assert 1 + 0.8 * may_be / 100 < max(ratios) < 1.005 + may_be / 100
    assert min(ratios) > 0.98
