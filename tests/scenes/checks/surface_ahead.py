# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Of a run of one step: no boundary point has moved farther than twice the
largest displacement of a cell and a grid spacing."""
import sys

import numpy

from tests.common.results import Results, initial_positions, positions

results = Results(sys.argv[1])
cells, surface = (
    numpy.linalg.norm(positions(points) - initial_positions(points),
                      axis=1).max()
    for points in (results.last_cells(), results.last_surface()))
limit = 2 * cells + results.number("Grid/Spacing")
print(f"displacements, um: cells {cells:g}, surface {surface:g}, "
      f"limit {limit:g}")
assert len(results.statistics()) == 2
assert surface <= limit * (1 + 1e-9)
# Else the scene would test nothing.
assert surface > 2 * cells
