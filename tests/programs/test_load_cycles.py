# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""An elastic load cycle that does not close exactly: by how much, and that
shorter steps cure it (doc/accuracy-and-cost.md, Load cycles)."""
import numpy

CYCLES = 5
SCENE = {"Dimension": 2, "Time/End time": CYCLES, "Tissue/Shape": "box",
         "Tissue/Size": "200, 100", "Tissue/Center": "0, 50", "Tissue/Cell spacing": 10,
         "Grid/Spacing": 37, "Grid/Offset": "3, 5", "Material/Volumetric strain": "pointwise",
         "Boundary conditions/Fixed where": "Y < 1 || Y > 99",
         "Boundary conditions/Displacement": f"if(Y > 50, 20*sin(2*{numpy.pi!r}*t), 0); 0",
         "Output/Interval": 1, "Output/Formats": "csv"}


def left(runs, step):
    """How far from where it began the farthest cell is after the first and
    after the last cycle, µm."""
    run = runs.run(f"step-{step}", SCENE, {"Time/Step": step})
    return [numpy.hypot(cells["x"] - cells["X"], cells["y"] - cells["Y"]).max()
            for cells in (run.cells(1), run.cells(CYCLES))]


def test_what_is_left_falls_with_the_step(runs):
    first, last = left(runs, 0.05)
    assert first < 0.2  # of a shear of 20 µm either way
    assert last < 0.6
    fine_first, fine_last = left(runs, 0.0125)
    assert fine_first < 0.2
    # What each further cycle adds is of the first order in the step.
    assert fine_last - fine_first < 0.4 * (last - first)
