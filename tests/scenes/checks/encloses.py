# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A surface that stays around its cells.

Sum of a n.x / dim over the volume of the cells, relative to what it was at
t = 0, in each output; the same from the columns of statistics.csv, and the
distance of the points from their cells. Arguments: by how much the first may
differ from 1; the largest distance, in grid spacings; the largest difference
of the radius from that of a ball of the same volume at the end, relative, if
the body is one.
"""
import sys

import numpy
from scipy.spatial import cKDTree

from tests.common.results import Results, positions, read_csv

results = Results(sys.argv[1])
dim = results.dimension
misfit, distance = map(float, sys.argv[2:4])
rows = results.statistics()
shares = []
for cells, surface in zip(map(read_csv, results.outputs("cells")),
                          map(read_csv, results.outputs("surface"))):
    row = numpy.flatnonzero(numpy.isclose(rows["time"], cells["time"][0]))[-1]
    x, centres = (positions(table)[:, :dim] for table in (surface, cells))
    vectors = numpy.stack([surface["area"] * surface["n" + axis]
                           for axis in "xyz"[:dim]], axis=1)
    middle = numpy.average(x, axis=0, weights=surface["area"])
    enclosed = (vectors * (x - middle)).sum() / dim
    shares.append(enclosed / cells["volume"].sum())
    away = cKDTree(centres).query(x)[0].max()
    assert abs(rows["enclosed_volume"][row] / enclosed - 1) < 1e-6
    assert abs(rows["surface_distance"][row] / away - 1) < 1e-6
    radii = numpy.linalg.norm(x - middle, axis=1)
    radius = (enclosed / (numpy.pi if dim == 2 else numpy.pi / 0.75))**(1 / dim)
shares = numpy.array(shares) / shares[0]
column = rows["enclosed_volume"] / rows["total_volume"]
farthest = rows["surface_distance"].max() / results.number("Grid/Spacing")
print("share of the cells' volume, of that at t = 0:", shares)
print("in any step:", column.min() / column[0], column.max() / column[0])
print("farthest point, in grid spacings:", farthest)
print("radii, of that of a ball:", radii.min() / radius, radii.max() / radius)
assert len(shares) > 2
assert abs(column / column[0] - 1).max() < misfit
assert farthest < distance
if len(sys.argv) > 4:
    assert abs(radii / radius - 1).max() < float(sys.argv[4])
