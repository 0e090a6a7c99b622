# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball between two planes, `upper` and `lower`, that each come nearer, at a
constant velocity: the forces on both are those on a linearly elastic ball
(tests/verification/pressed_ball.py), also in forces.csv, whose surface goes into the planes by the
pressure over kappa. Argument: the tolerance, relative.
"""
import sys

import numpy

from morula.run import Run, read_csv
from tests.common.results import Results, agree
from tests.verification import pressed_ball

results = Results(sys.argv[1])
tolerance = float(sys.argv[2])
R = results.number("Tissue/Radius")
E = results.number("Material/Young's modulus")
nu = results.number("Material/Poisson's ratio")
h = results.number("Grid/Spacing")
kappa = results.number("Obstacles/upper/Stiffness") * E / h
velocity = -float(results.keys["Obstacles/upper/Velocity"].split(";")[2])
ball = pressed_ball.Ball(results.lame())
surfaces = [read_csv(file) for file in results.outputs("surface")]
written = Run(results.directory).forces
assert len(surfaces) > 2
for before, surface in zip(surfaces, surfaces[1:]):
    assert (before["id"] == surface["id"]).all()
    delta = velocity * surface["time"][0]
    depths = [numpy.maximum(0, side * surface["z"] - (R - delta))
              for side in (1, -1)]
    # The term's area is that at the beginning of the step.
    forces = [kappa * numpy.sum(before["area"] * depth) for depth in depths]
    exact = R**2 * pressed_ball.force(ball, delta / R, 1 / (kappa * R))
    hertz = R**2 * pressed_ball.hertz(delta / R, E, nu)
    print(f"delta/R = {delta / R:g}: F/F_Hertz = {forces[0] / hertz:.4f}, of the "
          f"elastic ball {exact / hertz:.4f}; F/F_ball = {forces[0] / exact:.4f}")
    agree("force over that on the elastic ball", numpy.array(forces) / exact, 1,
          tolerance)
    now = written[written["time"] == surface["time"][0]].set_index("name")
    named = now.loc[["upper", "lower"]]
    agree("force in forces.csv over that on the elastic ball",
          named["force_inward"].to_numpy() / exact, 1, tolerance)
    agree("forces in forces.csv over those of the depths",
          -named["force_z"].to_numpy() / numpy.array(forces), [1, -1], 1e-3)
    agree("difference of the two forces over it", (forces[0] - forces[1]) / exact,
          0, 1e-3)
    agree("depth in the planes over h", numpy.max(depths) / h, 0, 0.01)
assert delta >= 0.05 * R
