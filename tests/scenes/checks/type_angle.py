# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Two liquid drops, left and right, of one area, that share an interface. With the
same tension gamma of both free surfaces and gamma_i of the interface, both have the
angle 180 - arccos(gamma_i / (2 gamma)) degrees where the three meet (Neumann). The
free surfaces are arcs, to which circles are fitted two grid spacings away from the
interface. Arguments: the tolerance in degrees; from which day on it must hold.
"""
import sys

import numpy
from scipy.spatial import cKDTree

from tests.common.results import Results, read_csv

results = Results(sys.argv[1])
tolerance, since = map(float, sys.argv[2:4])
gamma = results.number("Cell types/left/Tension/With surface")
assert gamma == results.number("Cell types/right/Tension/With surface")
between = results.number("Cell types/right/Tension/With left")
exact = 180 - numpy.degrees(numpy.arccos(between / (2 * gamma)))
h = results.number("Grid/Spacing")


def circle(places):
    """Centre and radius of the circle with the least squares of |x - c|^2 - R^2."""
    A = numpy.column_stack([2 * places, numpy.ones(len(places))])
    (x, y, c), *_ = numpy.linalg.lstsq(A, (places**2).sum(1), rcond=None)
    return numpy.array([x, y]), (c + x**2 + y**2)**0.5


found = 0
for file, of_surface in zip(results.outputs("cells"),
                            results.outputs("surface")):
    cells, surface = read_csv(file), read_csv(of_surface)
    X = numpy.column_stack([cells["x"], cells["y"]])
    S = numpy.column_stack([surface["x"], surface["y"]])
    nearest = cells["type"][cKDTree(X).query(S)[1]]
    axis = X[cells["type"] == 1].mean(0) - X[cells["type"] == 0].mean(0)
    axis /= numpy.linalg.norm(axis)
    # The interface is a straight line, as both drops have one pressure: half of
    # the area lies on each of its sides.
    along = X @ axis
    order = numpy.argsort(along)
    half = numpy.cumsum(cells["volume"][order]) / cells["volume"].sum()
    line = numpy.interp(0.5, half, along[order])
    angles = []
    for kind, side in ((0, -1), (1, 1)):
        arc = S[(nearest == kind) & (abs(S @ axis - line) > 2 * h)]
        center, R = circle(arc)
        assert R > 6 * h
        distance = side * (center @ axis - line)
        angles.append(180 - numpy.degrees(numpy.arccos(distance / R)))
    print("day", cells["time"][0], "angles:", angles, "exact:", exact)
    if cells["time"][0] >= since:
        found += 1
        assert max(abs(numpy.array(angles) - exact)) < tolerance
assert found >= 3
