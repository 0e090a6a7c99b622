# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A liquid drop (3-D: a ball) of one type of cells around the origin in another
liquid: the pressure in its middle is higher by (d - 1) gamma / R (Laplace), times
R <1/r> of the diffuse interface: the drop's fraction on the splines is the ball
smeared out by two quadratic splines, of the variance h^2/4 each, taken as one normal
distribution. Argument: the tolerance, relative.
"""
import sys

import numpy
from scipy.integrate import trapezoid
from scipy.stats import ncx2

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
r = numpy.linspace(0.001 * R, R + 6 * h, 4000)
slope = -numpy.gradient(ncx2.cdf(R**2 / (h**2 / 2), dim, r**2 / (h**2 / 2)), r)
exact = (dim - 1) * gamma * trapezoid(slope / r, r)
print("R/h:", R / h, "pressure of the drop, kPa:", jump, "exact:", exact,
      "part:", jump / exact, "of Laplace's:", jump * R / gamma / (dim - 1))
assert R > 3.9 * h
assert abs(jump / exact - 1) < float(sys.argv[2])
