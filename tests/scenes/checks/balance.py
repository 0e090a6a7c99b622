# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Exact balances of a body that nothing, or one slip plane, holds.

Sum V sigma_ij over the cells equals the moments sum f_i x_j of the forces on
its boundary points: none, dead traction, following pressure. All splines
together reproduce affine fields, so this holds for the discrete solution, up
to Newton's tolerance, not only in the limit. Arguments: 'free' or a slip
normal's axis; then the tolerance relative to sum V |sigma|.
"""
import sys

import numpy

from tests.common.results import (Results, agree, initial_positions, positions,
                                  stresses)

results = Results(sys.argv[1])
support, tolerance = sys.argv[2], float(sys.argv[3])
dim = results.dimension
cells, surface = results.last_cells(), results.last_surface()
x = positions(surface)
X = initial_positions(surface)
t = cells["time"][0]

forces = numpy.zeros((len(surface), dim))
loaded = surface["condition"] == 3
if results.keys["Boundary conditions/Pressure where"]:
    # loaded points all carry the pressure in these scenes
    normal = numpy.array([surface["nx"], surface["ny"], surface["nz"]]).T
    push = results.function("Boundary conditions/Pressure", X, t)
    forces -= (loaded * push * surface["area"])[:, None] * normal[:, :dim]
if results.keys["Boundary conditions/Traction where"]:
    initial = numpy.genfromtxt(results.outputs("surface")[0], delimiter=",",
                               names=True)
    pull = results.function("Boundary conditions/Traction", X, t)
    forces += (loaded * initial["area"])[:, None] * pull

sigma = stresses(cells)[:, :dim, :dim]
volume = cells["volume"][:, None, None]
scale = numpy.sum(volume * numpy.abs(sigma))
moments = numpy.einsum("pi,pj->ij", forces, x[:, :dim])
difference = (numpy.sum(volume * sigma, axis=0) - moments) / scale
if support in "xyz":
    # the reactions of the plane have moments of their own
    held = "xyz".index(support)
    difference[held, :] = 0.0
print("sum V |sigma|:", scale)
assert scale > 0.0
agree("sum V sigma against the forces' moments", difference, 0.0, tolerance)
