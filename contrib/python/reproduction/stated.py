# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The numbers that the paper states, with the place where it does."""
from morula.fits import Exponential, Line

# Fig. 3 (c-e), fitted for 2 <= t <= 4 days.
CELLS_FIT = Exponential(7500.0, 0.36)
VOLUME_FIT = Exponential(7.7e6, 0.31)  # µm³
ENERGY_FIT = Line(0.095, -0.029)  # kPa

# Section 2.5 and the caption of Fig. 2.
SPHERE_CELLS = 6.6e4
FINE_SPHERE_CELLS = 5.2e5
SPHERE_BOUNDARY_POINTS = 2.6e3

# Section 3.1.
CUBE_CELLS = 8.0e3
CUBE_BOUNDARY_POINTS = 2.9e3

# Section 3.2: cells of Fig. 4 (b, c), "1.5³ times" those of the start.
PICTURE_CELLS = 2.2e5
PICTURE_RATIO = 1.5**3

# Caption of Fig. 4 (e-g): "for 5 days".
CURVES_END = 5.0

# What is asked of a reproduction: fits' factors and slope relative, rates
# absolute (1/day).
FACTOR_TOLERANCE = 0.05
RATE_TOLERANCE = 0.02
SLOPE_TOLERANCE = 0.10
