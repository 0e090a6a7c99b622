# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Rigid obstacles: a ball between two planes, and one that grows in a mould."""
import numpy
import pytest

from morula.run import Run
from tests.common.results import agree, positions, read_csv, root, stresses
from tests.verification import pressed_ball


def test_hertz(scene):
    """A ball between two planes that each come 0.025 and then 0.05 R nearer: the
    forces on both, also in forces.csv, are those on a linearly elastic ball
    (tests/verification/pressed_ball.py), whose surface goes into the planes by the
    pressure over kappa. Hertz' law takes it for a half-space and has 8 and 11 %
    less."""
    R, h, velocity = 60, 6, 1.5
    keys = {"Time/End time": 2, "Tissue/Radius": R, "Tissue/Cell spacing": 3,
            "Tissue/Boundary points": 20000, "Grid/Spacing": h,
            "Obstacles/Names": "upper, lower", "Output/Interval": 1,
            "Solver/Newton tolerance": 1e-8}
    for name, side in (("upper", 1), ("lower", -1)):
        of = f"Obstacles/{name}/"
        keys.update({of + "Shape": "plane", of + "Center": f"0, 0, {side * R}",
                     of + "Normal": f"0, 0, {-side}",
                     of + "Velocity": f"0; 0; {-side * velocity}"})
    results = scene(keys)
    kappa = (results.number("Obstacles/upper/Stiffness")
             * results.number("Material/Young's modulus") / h)
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
        forces = numpy.array([kappa * numpy.sum(before["area"] * depth)
                              for depth in depths])
        exact = R**2 * pressed_ball.force(ball, delta / R, 1 / (kappa * R))
        agree("force over that on the elastic ball", forces / exact, 1, 0.03)
        now = written[written["time"] == surface["time"][0]].set_index("name")
        named = now.loc[["upper", "lower"]]
        agree("force in forces.csv over that on the elastic ball",
              named["force_inward"].to_numpy() / exact, 1, 0.03)
        agree("forces in forces.csv over those of the depths",
              -named["force_z"].to_numpy() / forces, [1, -1], 1e-3)
        agree("difference of the two forces over it", (forces[0] - forces[1]) / exact,
              0, 1e-3)
        agree("depth in the planes over h", numpy.max(depths) / h, 0, 0.01)
    assert delta >= 0.05 * R


@pytest.mark.quick
def test_mould(scene):
    """Growth of a ball of radius R in a rigid sphere of radius R_c: F = f I, free
    (f = theta) up to theta = R_c/R. Then the pressure
    p = -(mu (f^2/theta^2 - 1) + lambda ln J_e)/J_e, per grown volume, is that of the
    mould, alpha E/h (f R - R_c)."""
    results = scene(file="mould.prm")
    lame_lambda, mu = results.lame()
    R = results.number("Tissue/Radius")
    R_c = results.number("Obstacles/mould/Radius")
    kappa = (results.number("Obstacles/mould/Stiffness")
             * results.number("Material/Young's modulus")
             / results.number("Grid/Spacing"))
    written = Run(results.directory).forces
    touching = 0
    files = list(zip(results.outputs("cells"), results.outputs("surface")))
    for cells, surface in (map(read_csv, pair) for pair in files):
        t = cells["time"][0]
        theta = results.function("Growth/Isotropic/Stretch", numpy.zeros((1, 3)), t)[0]

        def inside(f):
            return -(mu * ((f / theta) ** 2 - 1)
                     + lame_lambda * 3 * numpy.log(f / theta)) * (theta / f)**3

        free = theta * R < R_c * (1 - 1e-12)
        f = theta if free else root(lambda f: inside(f) - kappa * (f * R - R_c),
                                    R_c / R, theta)
        touching += not free
        volume = cells["volume"]
        grown = numpy.sum(volume / cells["elastic_volume_ratio"]) / theta**3
        agree("f by the cells' volume, relative",
              (numpy.sum(volume) / grown) ** (1 / 3) / f, 1, 0.002)
        r = numpy.linalg.norm(positions(surface), axis=1)
        agree("f by the surface, relative",
              numpy.average(r, weights=surface["area"]) / (R * f), 1, 0.002)
        agree("radius of every patch, relative", r / (R * f), 1, 0.006)
        pressure = -numpy.einsum("pii->p", stresses(cells)) / 3
        agree("mean pressure over the largest of the run, kPa",
              numpy.average(pressure, weights=volume) - inside(f), 0, 0.03)
        if inside(f) > 0.01:
            # The area that it acts on is that at the beginning of the step.
            force = written[written["time"] == t]["force_inward"].to_numpy()
            agree("force on the mould in forces.csv over p times the area",
                  force / (inside(f) * 4 * numpy.pi * (R * f)**2), 1, 0.04)
    assert 3 <= touching < len(files) - 3
