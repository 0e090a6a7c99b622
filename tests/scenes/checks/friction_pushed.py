# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A free body whose force and friction have the same ratio everywhere moves by
Δt b(t)/ζ in each step, and is not deformed."""
import sys

from tests.common.results import (Results, agree, initial_positions, positions,
                                  stresses)

results = Results(sys.argv[1])
cells = results.last_cells()
X = initial_positions(cells)
step = results.number("Time/Step")
friction = results.function("Friction/Coefficient", X, 0)
moved = 0 * X
for i in range(round(results.number("Time/End time") / step)):
    force = results.function("Body force/Force density", X, (i + 1) * step)
    moved += step * force / friction[:, None]
agree("displacement, um", positions(cells) - X, moved, 1e-6)
agree("stress, kPa", stresses(cells), 0.0, 1e-8)
