# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The curvature of a strip of which the upper layer contracts along it:
doc/theory.md (9.2).

In plane strain both layers have the modulus E / (1 - nu^2), so that the ratio
of the stiffnesses is that of E. The strain along the strip alone counts: across
it nothing holds the layers. Arguments: thickness and stiffness of the upper
layer over those of the lower one.
"""
import sys

import numpy

from tests.common.results import (Results, agree, initial_positions, positions)

results = Results(sys.argv[1])
m, n = float(sys.argv[2]), float(sys.argv[3])
thickness = results.numbers("Tissue/Size")[1]
cells = results.last_cells()
X, x = initial_positions(cells), positions(cells)
gamma = cells["contraction"]
shortening = 1 - gamma.min()
assert shortening > 0.001 and gamma.max() == 1, (gamma.min(), gamma.max())
layer = gamma < 1
upper = thickness / (1 + 1 / m)
agree("share of cells that contract", layer.mean(), upper / thickness, 1e-12)

# Away from the ends, along the row of cells next to the middle.
near = numpy.abs(X[:, 0]) < 3 * thickness
row = near & (X[:, 1] == X[X[:, 1] > 0, 1].min())
slope, bend = numpy.polynomial.polynomial.polyfit(x[row, 0], x[row, 1], 2)[1:]
curvature = 2 * bend / (1 + slope ** 2) ** 1.5
exact = 6 * (1 + m) ** 2 / (3 * (1 + m) ** 2 + (1 + m * n)
                            * (m ** 2 + 1 / (m * n)))
computed = curvature * thickness / shortening
print("curvature times thickness over strain:", computed, "exact:", exact)
agree("curvature, relative", computed / exact, 1, 0.02)
