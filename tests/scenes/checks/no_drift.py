# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Rigid motions that nothing holds are zero: sum V0 u = 0, and after a single
step sum V0 (X - X_c) x u = 0. For scenes without division. Argument: 'free',
or the axis of the normal of the only slip plane.
"""
import sys

import numpy

from tests.common.results import Results, agree, initial_positions, positions

results = Results(sys.argv[1])
support = sys.argv[2]
cells = results.last_cells()
X = initial_positions(cells)
u = positions(cells) - X
weights = cells["initial_volume"]
held = [] if support == "free" else ["xyz".index(support)]
turnable = held or ([0, 1, 2] if results.dimension == 3 else [2])

drift = numpy.average(u, axis=0, weights=weights)
agree("drift of the center, um", numpy.delete(drift, held), 0.0, 1e-8)
print("largest displacement, um:", numpy.abs(u).max())
if len(results.statistics()) == 2:
    arm = X - numpy.average(X, axis=0, weights=weights)
    turn = (weights[:, None] * numpy.cross(arm, u)).sum(axis=0)
    agree("rotation of the whole", turn[turnable]
          / (weights * (arm**2).sum(axis=1)).sum(), 0.0, 1e-10)
