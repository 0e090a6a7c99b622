# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells of two sizes that exchange their places in a closed box: each place keeps its
space, so that both halves stay full while large and small cells mix."""
import numpy
import pytest
from scipy.spatial import Voronoi

EDGE = 120  # of a half, um
SCENE = {"Dimension": 2, "Time/End time": 12, "Time/Step": 0.1, "Tissue/Shape": "points",
         "Tissue/Points file": "cells.csv", "Tissue/Points surface": "outline.wkt",
         "Grid/Spacing": 30,
         "Boundary conditions/Slip where": 1,
         "Cell types/Names": "small, large", "Rearrangement/Diffusion": 100,
         "Output/Formats": "csv", "Output/Interval": 0}


def write_cells(runs):
    """Left cells of 100, right ones of 144 um^2."""
    rows = ["x,y,volume,type"]
    for side, n in ((-1, 12), (1, 10)):
        middles = (numpy.arange(n) + 0.5) * EDGE / n
        rows += [f"{side * x:.9g},{y - EDGE / 2:.9g},{(EDGE / n)**2:.9g},{int(side > 0)}"
                 for x in middles for y in middles]
    a, b = EDGE, EDGE / 2
    outline = f"POLYGON((-{a} -{b}, {a} -{b}, {a} {b}, -{a} {b}, -{a} -{b}))\n"
    return {"Tissue/Points file": runs.write("cells.csv", "\n".join(rows) + "\n"),
            "Tissue/Points surface": runs.write("outline.wkt", outline)}


def fill(cells, side):
    """Volumes of the cells well inside a half over their regions' areas."""
    x = cells[["x", "y"]].to_numpy()
    images = [x]
    for axis, wall in ((0, -EDGE), (0, EDGE), (1, -EDGE / 2), (1, EDGE / 2)):
        image = x.copy()
        image[:, axis] = 2 * wall - image[:, axis]
        images.append(image)
    diagram = Voronoi(numpy.concatenate(images))
    inside = (side * x[:, 0] > 30) & (side * x[:, 0] < 90) & (abs(x[:, 1]) < 40)
    area = 0
    for k in numpy.flatnonzero(inside):
        px, py = diagram.vertices[diagram.regions[diagram.point_region[k]]].T
        area += abs(numpy.dot(px, numpy.roll(py, 1)) - numpy.dot(py, numpy.roll(px, 1))) / 2
    return cells["volume"][inside].sum() / area


@pytest.mark.parametrize("offset", ["0, 0", "7, 11"])
def test_halves_stay_full(runs, offset):
    run = runs.run(f"at-{offset[0]}", {**SCENE, **write_cells(runs), "Grid/Offset": offset})
    before, after = run.cells(0), run.cells(1)
    assert 2 * run.statistics["exchanges"].sum() > 36 * len(before)
    assert (after["type"][after["x"] > 0] == 0).mean() > 0.1
    for side in (-1, 1):
        assert abs(fill(before, side) - 1) <= 1e-4
        assert abs(fill(after, side) - 1) <= 0.02
