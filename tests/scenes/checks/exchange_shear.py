# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Sheared tissue whose cells exchange places. A cell takes part in k exchanges a
day, k = 4 D/a^2 on a square lattice, each of which releases all shear at its place.
So the mean stress falls as the share e^(-kt) of places without any, and the cells
stand on the same places with the same volumes. Argument: the tolerance, relative.
"""
import sys

import numpy

from tests.common.results import Results, positions, read_csv

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
rows = results.statistics()
outputs = [read_csv(file) for file in results.outputs("cells")]
first, last = outputs[1], outputs[-1]  # after the first step it is sheared
n = len(last["id"])
a, D = results.number("Tissue/Cell spacing"), results.number(
    "Rearrangement/Diffusion")
t = last["time"][0]
part = 2 * rows["exchanges"].sum() / n
print("exchanges a cell:", part, "expected:", 4 * D / a**2 * t)
assert abs(part / (4 * D / a**2 * t) - 1) < 0.05
# The first output is behind the exchanges of the first step.
expected = numpy.exp(-2 * rows["exchanges"][2:].sum() / n)
fall = last["sigma_xy"].mean() / first["sigma_xy"].mean()
print("stress over that of the first output:", fall, "expected:", expected)
assert abs(fall / expected - 1) < tolerance
# No cell has been lost or doubled, and most stand elsewhere.
places = numpy.round(positions(last)[:, :2], 3)
assert len(numpy.unique(places, axis=0)) == n
assert abs(last["volume"].sum() / (480 * 480) - 1) < 1e-3
moved = numpy.hypot(last["x"] - last["X"] - 0.02 * last["Y"],
                    last["y"] - last["Y"]) > 0.5 * a
print("share of cells that stand elsewhere:", moved.mean())
assert 0.3 < moved.mean() < 0.9
