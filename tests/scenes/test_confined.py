# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth between slip walls, and layers that contract on others: closed forms."""
import numpy
import pytest
from scipy.optimize import fsolve

from tests.common.program import POINTWISE
from tests.common.results import (agree, initial_positions, positions, root,
                                  stresses)

pytestmark = pytest.mark.quick

STRETCH = "Growth/Isotropic/Stretch"
CUBE = {"Tissue/Shape": "box", "Tissue/Center": "0, 0, 40",
        "Tissue/Size": "80, 80, 80", "Tissue/Cell spacing": 10, "Grid/Spacing": 20,
        "Boundary conditions/Slip where": "Z < 79", "Growth/Law": "isotropic",
        STRETCH: "1 + 0.2*t"}
# With the published heights.
CONFINED = {
    "1.1": ({"keys": {**CUBE, STRETCH: "1 + 0.1*t"}}, 1.242376),
    "1.2": ({"keys": CUBE}, 1.500736),
    "1.4": ({"keys": {**CUBE, "Method": "paper", STRETCH: "1 + 0.4*t"}}, 2.055484),
    "isochoric": ({"keys": {**CUBE, "Material/Law": "isochoric neo-Hookean"}},
                  1.482983),
    "grown-volume-2d": ({"file": "confined-growth-2d.prm"}, None),
    "pooled-2d": ({"file": "confined-growth-2d.prm", "keys": {
        "Time/Step": 0.5, "Material/Energy per": "initial volume",
        "Material/Poisson's ratio": 0.48, "Material/Volumetric strain": "pooled",
        "Material/Law": "isochoric neo-Hookean", STRETCH: "1 + 0.2*t"}}, None)}


@pytest.mark.parametrize("name", CONFINED)
def test_confined_growth(scene, name):
    """Free on top, the last direction: F = diag(1, 1, theta Lambda),
    F_e = diag(1/theta, 1/theta, Lambda), and no stress across the top. Exact, as
    the grid lines pass between the lattice's cells at the start. Pooled, the
    walls give way by the gap at which the penalty alpha (lambda + 2 mu) / h
    balances the pressure."""
    options, published = CONFINED[name]
    results = scene(**options)
    dim = results.dimension
    up = dim - 1
    bottom = results.numbers("Tissue/Center") - results.numbers("Tissue/Size") / 2
    cells = results.last_cells()
    X = initial_positions(cells)
    theta = results.function(STRETCH, X, cells["time"][0])[0]

    def stress(Lambda):
        b_e = numpy.ones(3)
        b_e[:dim] = theta**-2
        b_e[up] = Lambda**2
        return results.stress_of(b_e)

    Lambda = root(lambda L: stress(L)[up], 0.1, 10)
    height = theta * Lambda
    if published:
        agree("closed form against the published height", height, published, 1e-6)
    weight = theta**dim if results.per_grown_volume() else 1.0
    sigma = numpy.diag(weight / height * stress(Lambda))
    gap = give = 0.0
    if results.is_pooled():
        lame_lambda, mu = results.lame()
        stiffness = lame_lambda + 2 * mu
        gap = (numpy.abs(stress(Lambda)).max() * results.number("Grid/Spacing")
               / results.number("Boundary conditions/Nitsche penalty") / stiffness)
        give = stiffness * 2 * gap / results.numbers("Tissue/Size").min()
    exact = X.copy()
    exact[:, up] = bottom[up] + height * (X[:, up] - bottom[up])
    agree("position, um", positions(cells), exact, 1e-6 + 4 * gap)
    agree("stress, kPa", stresses(cells), sigma, 1e-8 + 4 * give)
    row = results.statistics()[-1]
    agree("height of the surface, um", row["xyz"[up] + "max"] - bottom[up],
          height * results.numbers("Tissue/Size")[up], 1e-6 + 4 * gap)


def test_dead_pull(scene):
    """Growth to twice the length under a dead traction along x, free along y, in
    plane strain: F = diag(a, b), F_e = F / theta, tau_xx = a t_x, tau_yy = 0. Fewer
    than two cells fill a grid spacing along the pull at the end. Cells' points stand
    in their deformed boxes; in cubes of the same volume the energy was 7 % too high,
    J_e wrong by 12 %."""
    results = scene({
        **POINTWISE, "Dimension": 2, "Time/Step": 0.02, "Tissue/Shape": "box",
        "Tissue/Size": "200, 100", "Tissue/Cell spacing": 10, "Grid/Spacing": 50,
        "Grid/Offset": "3.3, 8.1", "Grid/Points per cell": 2,
        "Material/Poisson's ratio": 0.3, "Growth/Law": "isotropic", STRETCH: "1 + t",
        "Boundary conditions/Slip where": "(X < -99.9) || (Y < -49.9)",
        "Boundary conditions/Traction where": "X > 99.9",
        "Boundary conditions/Traction": "0.3*t; 0; 0",
        "Boundary conditions/Nitsche form": "symmetric",
        "Boundary conditions/Nitsche penalty": 1000, "Solver/Newton tolerance": 1e-6})
    lame_lambda, mu = results.lame()
    rows = results.statistics()
    last = rows[-1]
    X = numpy.array([[100.0, 0.0, 0.0]])
    theta = results.function(STRETCH, X, last["time"])[0]
    traction = results.function("Boundary conditions/Traction", X, last["time"])[0, 0]

    def unbalanced(stretches):
        ln_J_e = numpy.log(stretches.prod() / theta**2)
        tau = mu * ((stretches / theta)**2 - 1) + lame_lambda * ln_J_e
        return tau - numpy.array([traction * stretches[0], 0])

    a, b = fsolve(unbalanced, [2 * theta, 0.7 * theta], xtol=1e-13)
    size = results.numbers("Tissue/Size")
    J_e = a * b / theta**2
    energy = (lame_lambda / 2 * numpy.log(J_e)**2
              + mu / 2 * ((a**2 + b**2) / theta**2 - 2 - 2 * numpy.log(J_e)))
    agree("length, relative", (last["xmax"] - last["xmin"]) / size[0] / a, 1, 0.01)
    agree("width, relative", (last["ymax"] - last["ymin"]) / size[1] / b, 1, 0.01)
    agree("energy density, relative", last["mean_energy_density"] / energy, 1, 0.01)
    for end in ("min", "max"):
        agree(f"{end} J_e, relative", last[f"{end}_elastic_volume_ratio"] / J_e, 1,
              0.03)
    length = results.number("Tissue/Cell spacing") * a
    agree("cells per grid spacing", last["min_cells_per_spacing"],
          results.number("Grid/Spacing") / length, 0.04)


@pytest.mark.parametrize("upper, stiffness", [(0.5, 1), (0.2, 10)])
def test_bilayer(scene, upper, stiffness):
    """The upper part of a strip, as stiff or stiffer, contracts along it, and the
    strip bends as a bimetal does (Timoshenko 1925; doc/theory.md (9.2)). In plane
    strain both layers have the modulus E / (1 - nu^2), so that the ratio of the
    stiffnesses is that of E."""
    thickness = 20
    top = f"(Y > {10 - upper * thickness})"
    results = scene({
        "Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": f"200, {thickness}",
        "Tissue/Cell spacing": 1, "Grid/Spacing": 4, "Contraction/Direction": "1; 0",
        "Material/Young's modulus": f"if({top}, {stiffness}, 1)",
        "Contraction/Stretch": f"1 - 0.004*t*{top}",
        "Solver/Newton tolerance": 1e-11})
    m = upper / (1 - upper)
    cells = results.last_cells()
    X, x = initial_positions(cells), positions(cells)
    gamma = cells["contraction"]
    shortening = 1 - gamma.min()
    assert shortening > 0.001 and gamma.max() == 1
    agree("share of cells that contract", (gamma < 1).mean(), upper, 1e-12)
    # Away from the ends, along the row of cells next to the middle.
    row = ((numpy.abs(X[:, 0]) < 3 * thickness)
           & (X[:, 1] == X[X[:, 1] > 0, 1].min()))
    slope, bend = numpy.polynomial.polynomial.polyfit(x[row, 0], x[row, 1], 2)[1:]
    curvature = 2 * bend / (1 + slope ** 2) ** 1.5
    exact = 6 * (1 + m) ** 2 / (3 * (1 + m) ** 2 + (1 + m * stiffness)
                                * (m ** 2 + 1 / (m * stiffness)))
    agree("curvature, relative", curvature * thickness / shortening / exact, 1, 0.02)
