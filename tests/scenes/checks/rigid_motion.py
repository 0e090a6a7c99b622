# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A body whose held points move rigidly follows: x = X + u(X, t), no stress.

The motion is the key Displacement itself, here for all cells.
"""
import sys

from tests.common.results import (Results, agree, initial_positions, positions,
                                  stresses)

results = Results(sys.argv[1])
cells = results.last_cells()
dim = results.dimension
X = initial_positions(cells)
moved = X[:, :dim] + results.function("Boundary conditions/Displacement", X,
                                      cells["time"][0])
agree("position, um", positions(cells)[:, :dim], moved, 1e-6)
agree("stress, kPa", stresses(cells), 0.0, 1e-8)
agree("volume ratio", cells["elastic_volume_ratio"], 1.0, 1e-8)
