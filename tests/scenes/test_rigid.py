# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies whose surface is held: growth without room, and rigid motions. Exact, as
the grid lines pass between the lattice's cells at the start."""
import numpy
import pytest

from tests.common.results import agree, initial_positions, positions, stresses

pytestmark = pytest.mark.quick

CUBE = {"Method": "paper", "Time/Step": 0.25, "Tissue/Shape": "box",
        "Tissue/Center": "0, 0, 40", "Tissue/Size": "80, 80, 80",
        "Tissue/Cell spacing": 10, "Grid/Spacing": 20,
        "Boundary conditions/Fixed where": 1, "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.4*t"}
PLAIN = {"Tissue/Size": "80, 120", "Grid/Extension": "false", "Time/Step": 0.5,
         "Growth/Isotropic/Stretch": "1 + 0.2*t"}
BOXES = {"plane": {"file": "rigid-box-2d.prm"},
         "without-extension": {"file": "rigid-box-2d.prm", "keys": PLAIN},
         "grown-volume": {"keys": {**CUBE, "Material/Energy per": "grown volume"}},
         "initial-volume": {"keys": {**CUBE, "Material/Energy per": "initial volume"}}}


@pytest.mark.parametrize("box", BOXES)
def test_rigid_box(scene, box):
    """F = I, so F_e = I / theta. tau = mu (b_e - I) + lambda ln J_e I, and the
    Cauchy stress is tau counted per initial volume, det F_g tau per grown volume.
    In 2-D growth acts in the plane: b_e,zz = 1."""
    results = scene(**BOXES[box])
    lame_lambda, mu = results.lame()
    dim = results.dimension
    cells = results.last_cells()
    X = initial_positions(cells)
    theta = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])
    ln_J_e = -dim * numpy.log(theta)
    weight = theta**dim if results.per_grown_volume() else 1.0
    exact = numpy.zeros((len(cells), 3, 3))
    for i in range(3):
        b_e = theta**-2 if i < dim else 1.0
        exact[:, i, i] = weight * (mu * (b_e - 1) + lame_lambda * ln_J_e)
    agree("position, um", positions(cells), X, 1e-7)
    agree("stress, kPa", stresses(cells), exact, 1e-8)
    agree("elastic volume ratio", cells["elastic_volume_ratio"], theta**-dim, 1e-9)
    energy = (lame_lambda / 2 * ln_J_e**2
              + mu / 2 * (dim * (theta**-2 - 1) - 2 * ln_J_e))
    agree("energy density, kPa", cells["energy_density"], energy, 1e-8)


def test_without_extension(runs):
    """What the extension is for: a half-fixed sphere without it fails in its first
    step. The message says when, and how to go on."""
    said = runs.execute("without-extension-fails.prm", code=2).text
    assert "The run failed: At t = 0 day: the step failed" in said
    assert "--resume" in said


def turn_in_space(angle):
    """The displacement of a turn about (1, 2, 2)/3."""
    c, s = f"(1-cos({angle}))", f"sin({angle})"
    return (f"(-8/9)*{c}*X + (-2/3)*{s}*Y + (2/9)*{c}*Y + (2/3)*{s}*Z + (2/9)*{c}*Z",
            f"(2/3)*{s}*X + (2/9)*{c}*X + (-5/9)*{c}*Y + (-1/3)*{s}*Z + (4/9)*{c}*Z",
            f"(-2/3)*{s}*X + (2/9)*{c}*X + (1/3)*{s}*Y + (4/9)*{c}*Y + (-5/9)*{c}*Z")


MOVED = "Boundary conditions/Displacement"
BALL = {"Time/Step": 0.25, "Tissue/Radius": 50, "Tissue/Cell spacing": 10,
        "Tissue/Lattice offset": "1, -2, 3", "Grid/Spacing": 27,
        "Grid/Offset": "3.3, 8.1, -2.7", "Solver/Newton tolerance": 1e-12,
        "Boundary conditions/Fixed where": "Z <= 0",
        MOVED: "{} + 20*t; {} + -13*t; {} + 9*t".format(*turn_in_space("0.5*t"))}
AT_ONCE = {"Time/Step": 1, "Boundary conditions/Nitsche form": "symmetric",
           "Boundary conditions/Nitsche penalty": 1000}
MOTIONS = {
    "plane": {"file": "rigid-motion-2d.prm"},
    "space": {"keys": BALL},
    # By 20 grid spacings in the only step.
    "far-in-plane": {"file": "rigid-motion-2d.prm", "keys": {
        **AT_ONCE, MOVED: "X*(cos(2.5)-1) - Y*sin(2.5) + 540;"
                          "X*sin(2.5) + Y*(cos(2.5)-1) - 81; 0"}},
    "far-in-space": {"keys": {
        **BALL, **AT_ONCE,
        MOVED: "{} + 540; {} + -13; {} + 9".format(*turn_in_space("2"))}}}


@pytest.mark.parametrize("motion", MOTIONS)
def test_rigid_motion(scene, motion):
    """A body whose held points move rigidly follows: x = X + u(X, t), no stress.
    The motion is the key Displacement itself, here for all cells."""
    results = scene(**MOTIONS[motion])
    cells = results.last_cells()
    dim = results.dimension
    X = initial_positions(cells)
    moved = X[:, :dim] + results.function(MOVED, X, cells["time"][0])
    agree("position, um", positions(cells)[:, :dim], moved, 1e-6)
    agree("stress, kPa", stresses(cells), 0.0, 1e-8)
    agree("volume ratio", cells["elastic_volume_ratio"], 1.0, 1e-8)
