# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies that nothing holds, or one slip plane: free growth, exact balances, no
drift, and friction with a medium."""
import numpy
import pytest

from tests.common.program import POINTWISE, WHOLE
from tests.common.results import (agree, initial_positions, positions, read_csv,
                                  stresses)

pytestmark = pytest.mark.quick

OPTIONS = {"Tissue/Surface cells": "trimmed", "Grid/Points per cell": 2}
POINTS = {"Tissue/Shape": "points", "Tissue/Points file": "scattered-cells.csv",
          "Tissue/Center": "0, 0, 0", "Grid/Offset": "0, 0, 0"}


@pytest.mark.parametrize("keys", [{}, OPTIONS, POINTS],
                         ids=["offset", "options", "points"])
def test_free_growth(scene, keys):
    """Uniform growth on a shifted lattice and grid; trimmed, with several points a
    cell; of scattered cells of unequal volumes: x - x_c = theta (X - X_c) without
    stress, and the centre, weighted with the initial volumes, stays."""
    results = scene(keys, "free-growth-offset.prm")
    cells = results.last_cells()
    X = initial_positions(cells)
    theta = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])[0]
    centre = numpy.average(X, axis=0, weights=cells["initial_volume"])
    agree("position, um", positions(cells), centre + theta * (X - centre), 1e-6)
    agree("stress, kPa", stresses(cells), 0.0, 1e-8)
    agree("volume, relative", cells["volume"] / cells["initial_volume"], theta**3,
          1e-8)


def no_drift(results, support):
    """Rigid motions that nothing holds are zero: sum V0 u = 0, and after a single
    step sum V0 (X - X_c) x u = 0. `support`: "free", or the axis of the normal of the
    only slip plane."""
    cells = results.last_cells()
    X = initial_positions(cells)
    u = positions(cells) - X
    weights = cells["initial_volume"]
    held = [] if support == "free" else ["xyz".index(support)]
    turnable = held or ([0, 1, 2] if results.dimension == 3 else [2])
    drift = numpy.average(u, axis=0, weights=weights)
    agree("drift of the center, um", numpy.delete(drift, held), 0.0, 1e-8)
    assert numpy.abs(u).max() > 1e-3
    if len(results.statistics()) == 2:
        arm = X - numpy.average(X, axis=0, weights=weights)
        turn = (weights[:, None] * numpy.cross(arm, u)).sum(axis=0)
        agree("rotation of the whole", turn[turnable]
              / (weights * (arm**2).sum(axis=1)).sum(), 0.0, 1e-10)


def balance(results, support, tolerance):
    """Sum V sigma_ij over the cells equals the moments sum f_i x_j of the forces on
    the boundary points: none, dead traction, following pressure. All splines
    together reproduce affine fields, so this holds for the discrete solution, up to
    Newton's tolerance, not only in the limit. The tolerance is relative to
    sum V |sigma|."""
    dim = results.dimension
    cells, surface = results.last_cells(), results.last_surface()
    x, X = positions(surface), initial_positions(surface)
    t = cells["time"][0]
    forces = numpy.zeros((len(surface), dim))
    loaded = surface["condition"] == 3
    if results.keys["Boundary conditions/Pressure where"]:
        # loaded points all carry the pressure in these scenes
        normal = numpy.array([surface["nx"], surface["ny"], surface["nz"]]).T
        push = results.function("Boundary conditions/Pressure", X, t)
        forces -= (loaded * push * surface["area"])[:, None] * normal[:, :dim]
    if results.keys["Boundary conditions/Traction where"]:
        initial = read_csv(results.outputs("surface")[0])
        pull = results.function("Boundary conditions/Traction", X, t)
        forces += (loaded * initial["area"])[:, None] * pull
    sigma = stresses(cells)[:, :dim, :dim]
    volume = cells["volume"][:, None, None]
    scale = numpy.sum(volume * numpy.abs(sigma))
    assert scale > 0.0
    moments = numpy.einsum("pi,pj->ij", forces, x[:, :dim])
    difference = (numpy.sum(volume * sigma, axis=0) - moments) / scale
    if support in "xyz":
        # the reactions of the plane have moments of their own
        difference["xyz".index(support), :] = 0.0
    agree("sum V sigma against the forces' moments", difference, 0.0, tolerance)


BALL = {"Tissue/Radius": 60, "Tissue/Cell spacing": 10, "Grid/Spacing": 35,
        "Grid/Offset": "4, 9, 15", "Material/Volumetric strain": "pointwise"}
GRADED = {"Growth/Law": "isotropic", "Growth/Isotropic/Stretch":
          "1 + 0.2*t*((X/60)^2 + (Y/60 - 0.3)^2 + Z/60)"}
BALANCED = {
    "free-disc": ({"keys": {
        **BALL, "Dimension": 2, "Tissue/Radius": 100, "Grid/Offset": "4, 9", **GRADED, "Growth/Isotropic/Stretch":
            "1 + 0.2*t*((X/100)^2 + (Y/100 - 0.3)^2 + X/100)"}}, "free", 1e-8),
    "free-sphere": ({"keys": {**BALL, **GRADED, "Time/Step": 0.5}}, "free", 1e-8),
    # Up to the small part of the pressure that the surface's points leave
    # unbalanced, which no motion of the whole answers.
    "pressure": ({"file": "balance-pressure.prm"}, "free", 3e-5),
    # Up to the gap that the penalty leaves.
    "slip-plane": ({"keys": {
        **BALL, **GRADED, "Tissue/Shape": "box", "Tissue/Center": "0, 0, 50",
        "Tissue/Size": "100, 100, 100", "Grid/Offset": "4, 9, 0",
        "Boundary conditions/Slip where": "Z <= 0",
        "Boundary conditions/Slip normal": "0, 0, 1"}}, "z", 3e-4),
    "traction": ({"file": "balance-traction.prm"}, "free", 1e-8)}


@pytest.mark.parametrize("name", BALANCED)
def test_balance(scene, name):
    options, support, tolerance = BALANCED[name]
    results = scene(**options)
    balance(results, support, tolerance)
    no_drift(results, support)


PUSH = {**BALL, **GRADED, "Body force/Force density": "1e-4 + 1e-6*Y; 2e-4*X/60; 0"}


@pytest.mark.parametrize("friction", ["", "1e-12"])
def test_unbalanced_force(scene, friction):
    """A free sphere pushed and turned by a body force that nothing balances, while
    it grows, also in a medium whose friction is too weak to say where the whole goes:
    it deforms but does not move as a whole."""
    keys = {"Friction/Coefficient": friction} if friction else {}
    no_drift(scene({**PUSH, **keys}), "free")


def test_friction_of_a_pushed_ball(scene):
    """A free ball that a body force pushes through a medium moves by dt b/zeta in
    each step, and the second half of it, with ten times the friction and force, does
    not deform it."""
    step = 0.25
    results = scene({
        **BALL, "Time/Step": step,
        "Body force/Force density": "(1 + 9*(Y > 0))*1e-4*t; (1 + 9*(Y > 0))*2e-4; 0",
        "Friction/Coefficient": "(1 + 9*(Y > 0))*1e-5"})
    cells = results.last_cells()
    X = initial_positions(cells)
    friction = results.function("Friction/Coefficient", X, 0)
    moved = sum(step * results.function("Body force/Force density", X, (i + 1) * step)
                for i in range(4)) / friction[:, None]
    agree("displacement, um", positions(cells) - X, moved, 1e-6)
    agree("stress, kPa", stresses(cells), 0.0, 1e-8)


def test_friction_of_a_column(scene):
    """A column between slip walls settles against friction under a small weight:
    zeta du/dt = M d2u/dY2 - b, M = lambda + 2 mu, without displacement at Y = 0 and
    traction at the top. In backward Euler's method the part of sin(k Y),
    k = (n + 1/2) pi/l0, is its last value times 1 - (1 + M k^2/zeta dt)^-i after i
    steps, dt being a third of the longest wave's time."""
    length, step, weight, friction = 200, 0.5, 1e-6, 1e-4
    results = scene({
        "Dimension": 2, "Time/End time": 2, "Time/Step": step, "Tissue/Shape": "box",
        "Tissue/Center": "0, 100", "Tissue/Size": f"80, {length}",
        "Tissue/Cell spacing": 5, "Grid/Spacing": 20,
        "Boundary conditions/Slip where": "Y < 199", "Material/Poisson's ratio": 0,
        "Body force/Force density": f"0; -{weight}; 0",
        "Friction/Coefficient": friction, "Output/Interval": 1, **POINTWISE})
    lame_lambda, mu = results.lame()
    k = (numpy.arange(200)[:, None] + 0.5) * numpy.pi / length
    rate = (lame_lambda + 2 * mu) * k**2 / friction
    files = results.outputs("cells")[1:]
    assert len(files) == 2
    for cells in map(read_csv, files):
        Y = initial_positions(cells)[:, 1]
        steps = round(cells["time"][0] / step)
        settled = (2 * weight / (length * friction * rate * k) * numpy.sin(k * Y)
                   * (1 - (1 + rate * step)**-steps)).sum(axis=0)
        agree(f"settling after {steps} steps",
              (Y - positions(cells)[:, 1]) / settled.max(),
              settled / settled.max(), 2e-3)


def test_surface_ahead(scene):
    """The tips of a long ellipse stand off from the nearest cell by three grid
    spacings, and the displacement there is extrapolated. No point of the surface
    moves farther than is told from the cells (268 um else), and the traction of held
    ones, which is extrapolated as well, does not count (else the run fails)."""
    h = 40
    results = scene({
        **WHOLE, "Dimension": 2, "Tissue/Shape": "ellipsoid", "Tissue/Size": "400, 22",
        "Tissue/Cell spacing": 20, "Tissue/Boundary points": 200, "Grid/Spacing": h,
        "Grid/Offset": "3.3, 8.1", "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.3*t*sin(X/30)",
        "Boundary conditions/Fixed where": "X > 150",
        "Boundary conditions/Nitsche form": "symmetric",
        "Boundary conditions/Nitsche penalty": 1000, "Solver/Newton tolerance": 1e-6})
    cells, surface = (
        numpy.linalg.norm(positions(points) - initial_positions(points), axis=1).max()
        for points in (results.last_cells(), results.last_surface()))
    assert len(results.statistics()) == 2
    # Else the scene would test nothing.
    assert 2 * cells < surface <= (2 * cells + h) * (1 + 1e-9)


def test_shrinking_ball(scene):
    """A ball whose cells shrink to half their length and grow back. Its patches
    merge and are split again; their number per area stays, also in a run that goes
    on."""
    keys = {
        "Time/End time": 2, "Time/Step": 0.1, "Tissue/Radius": 60,
        "Tissue/Cell spacing": 10, "Tissue/Refine surface": "true",
        "Tissue/Coarsen surface": "true", "Grid/Spacing": 30,
        "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 - 0.5*(1 - abs(1 - t))",
        "Boundary conditions/Pressure where": "Z > 0",
        "Boundary conditions/Pressure": 0.01, "Output/Interval": 0.1,
        "Solver/Newton tolerance": 1e-6}
    results = scene({**keys, "Time/End time": 0.5}, then=keys)
    density, closed = [], []
    for points in map(read_csv, results.outputs("surface")):
        area = points["area"]
        normals = numpy.array([points[name] for name in ("nx", "ny", "nz")])
        density.append(len(points) / area.sum())
        closed.append(numpy.linalg.norm((normals * area).sum(axis=1)) / area.sum())
    assert len(density) > 15
    agree("patches per area, of those at t = 0, logarithm to base 2",
          numpy.log2(numpy.array(density) / density[0]), 0, 1)
    agree("sum of the area vectors over the area", closed, closed[0], 0.02)
