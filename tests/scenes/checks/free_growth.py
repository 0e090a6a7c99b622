# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A free body that grows uniformly: x - x_c = theta (X - X_c), no stress.

The centre, weighted with the initial volumes, stays.
"""
import sys

import numpy

from tests.common.results import (Results, agree, initial_positions, positions,
                                  stresses)

results = Results(sys.argv[1])
cells = results.last_cells()
X = initial_positions(cells)
theta = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])[0]
centre = numpy.average(X, axis=0, weights=cells["initial_volume"])
exact = centre + theta * (X - centre)
if results.dimension == 2:
    exact[:, 2] = 0.0

agree("position, um", positions(cells), exact, 1e-6)
agree("stress, kPa", stresses(cells), 0.0, 1e-8)
agree("volume, relative", cells["volume"] / cells["initial_volume"],
      theta**results.dimension, 1e-8)
