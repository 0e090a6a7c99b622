# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Patches per area of tissue that shrinks and grows back, at all outputs."""
import sys

import numpy

from tests.common.results import Results, agree, read_csv

results = Results(sys.argv[1])
density, closed = [], []
for file in results.outputs("surface"):
    points = read_csv(file)
    area = points["area"]
    normals = numpy.array([points[name] for name in ("nx", "ny", "nz")])
    density.append(len(points) / area.sum())
    closed.append(numpy.linalg.norm((normals * area).sum(axis=1)) / area.sum())
share = numpy.array(density) / density[0]
print("patches per area, of those at t = 0:", share)
assert len(share) > 15
agree("patches per area", numpy.log2(share), 0, 1)
agree("sum of the area vectors over the area", closed, closed[0], 0.02)
