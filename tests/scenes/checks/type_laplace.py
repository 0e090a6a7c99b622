# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A liquid drop (3-D: a ball) of one type of cells around the origin in another
liquid: the pressure in its middle is higher by (d - 1) gamma / R (Laplace).
Argument: the tolerance, relative.
"""
import sys

import numpy

from tests.common.results import Results, positions, stresses

results = Results(sys.argv[1])
dim, h = results.dimension, results.number("Grid/Spacing")
cells = results.last_cells()
r = numpy.linalg.norm(positions(cells)[:, :dim], axis=1)
V, inside = cells["volume"], cells["type"] == 1
volume = V[inside].sum()
R = (volume / numpy.pi)**0.5 if dim == 2 else (volume * 0.75 / numpy.pi)**(1 / 3)
gamma = results.number("Cell types/drop/Tension/With around")
pressure = -numpy.einsum("pii->p", stresses(cells)[:, :dim, :dim]) / dim
middle, far = r < 0.4 * R, (r > R + 2 * h) & (r < r.max() - 0.6 * h)
jump = (numpy.average(pressure[middle], weights=V[middle]) -
        numpy.average(pressure[far], weights=V[far]))
print("R/h:", R / h, "pressure of the drop, kPa:", jump, "of Laplace's:",
      jump * R / gamma / (dim - 1))
assert R > 3.9 * h
assert abs(jump * R / gamma / (dim - 1) - 1) < float(sys.argv[2])
