# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball between two planes, `upper` and `lower`, that have each come nearer by
delta: the forces on both are Hertz'. Argument: the tolerance, relative.
"""
import sys

import numpy

from tests.common.results import Results, agree

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
surface = results.last_surface()
R = results.number("Tissue/Radius")
E = results.number("Material/Young's modulus")
nu = results.number("Material/Poisson's ratio")
t = surface["time"][0]
delta = -t * float(results.keys["Obstacles/upper/Velocity"].split(";")[2])
kappa = (results.number("Obstacles/upper/Stiffness") * E
         / results.number("Grid/Spacing"))
hertz = 4 * E * numpy.sqrt(R) * delta**1.5 / (3 * (1 - nu**2))
print("delta/R:", delta / R, "force after Hertz, kPa um^2:", hertz)
assert delta > 0.02 * R
depths = [numpy.maximum(0, side * surface["z"] - (R - delta)) for side in (1, -1)]
forces = [kappa * numpy.sum(surface["area"] * depth) for depth in depths]
agree("force over Hertz'", numpy.array(forces) / hertz, 1, tolerance)
agree("difference of the two forces over Hertz'",
      (forces[0] - forces[1]) / hertz, 0, 1e-3)
agree("depth in the planes over h", numpy.max(depths)
      / results.number("Grid/Spacing"), 0, 0.01)
