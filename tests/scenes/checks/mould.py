# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Isotropic growth of a ball (2-D: a disc) of radius R in a rigid one of radius
R_c: F = f I, free (f = theta) up to theta = R_c/R. Then the pressure
p = -(mu (f^2/theta^2 - 1) + lambda ln J_e)/f^d, per initial volume, is that of
the mould, alpha E/h (f R - R_c). Argument: the tolerance of f, relative.
"""
import sys

import numpy

from tests.common.results import (Results, agree, positions, root, stresses)
from morula.run import Run, read_csv

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
dim = results.dimension
lame_lambda, mu = results.lame()
R = results.number("Tissue/Radius")
R_c = results.number("Obstacles/mould/Radius")
kappa = (results.number("Obstacles/mould/Stiffness")
         * results.number("Material/Young's modulus")
         / results.number("Grid/Spacing"))
written = Run(results.directory).forces
touching = 0
for cells_file, surface_file in zip(results.outputs("cells"),
                                    results.outputs("surface")):
    cells, surface = read_csv(cells_file), read_csv(surface_file)
    t = cells["time"][0]
    theta = results.function("Growth/Isotropic/Stretch", numpy.zeros((1, 3)), t)[0]

    def inside(f):
        return -(mu * ((f / theta) ** 2 - 1)
                 + lame_lambda * dim * numpy.log(f / theta)) / f**dim

    free = theta * R < R_c * (1 - 1e-12)
    f = theta if free else root(lambda f: inside(f) - kappa * (f * R - R_c),
                                R_c / R, theta)
    touching += not free
    volume = cells["volume"]
    print(f"t = {t:g}: theta = {theta:g}, f = {f:.6f}, p = {inside(f):.4f} kPa")
    grown = numpy.sum(volume / cells["elastic_volume_ratio"]) / theta**dim
    agree("f by the cells' volume, relative",
          (numpy.sum(volume) / grown) ** (1 / dim) / f, 1, tolerance)
    r = numpy.linalg.norm(positions(surface)[:, :dim], axis=1)
    agree("f by the surface, relative",
          numpy.average(r, weights=surface["area"]) / (R * f), 1, tolerance)
    agree("radius of every patch, relative", r / (R * f), 1, 3 * tolerance)
    pressure = -numpy.einsum("pii->p", stresses(cells)[:, :dim, :dim]) / dim
    agree("mean pressure over the largest of the run, kPa",
          numpy.sum(volume * pressure) / numpy.sum(volume) - inside(f), 0, 0.03)
    now = written[written["time"] == t]
    if inside(f) > 0.01:
        area = (2 * numpy.pi if dim == 2 else 4 * numpy.pi) * (R * f) ** (dim - 1)
        # The area that it acts on is that at the beginning of the step.
        agree("force on the mould in forces.csv over p times the area",
              now["force_inward"].to_numpy() / (inside(f) * area), 1, 0.04)
assert 3 <= touching < len(results.outputs("cells")) - 3
