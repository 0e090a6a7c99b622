# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Patch tests: affine and rigid motions and free growth, for any cut of the
grid."""
import numpy

from tests.common.results import initial_positions, positions, stresses
from tests.verification.errors import norm
from tests.verification.ladder import Ladder, ladders, spacing
from tests.verification.material import cauchy, lame

PLANE, SPACE = ("patch-2d.prm",), ("patch-3d.prm",)
EXACT = {"displacement": 1e-8, "stress [kPa]": 1e-8}
ALIGNED = {"Tissue/Shape": "box", "Tissue/Surface mesh": "",
           "Tissue/Size": "120, 80, 80",
           "Grid/Offset": "0, 0, 0", "Tissue/Cell spacing": "4",
           "Solver/Newton tolerance": "1e-12"}
QUADRATURE = {"displacement": 1.2, "stress": 1.2}
TURN = {"Boundary conditions/Displacement":
        "(cos(t)-1)*X - sin(t)*Y + 20*t; sin(t)*X + (cos(t)-1)*Y - 13*t; 9*t",
        "Time/Step": "0.25", "Solver/Newton tolerance": "1e-12"}
GROW = {"Boundary conditions/Fixed where": "", "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.5*t", "Time/Step": "0.25"}


def turned_lattice(_):
    """A square of 20 x 20 cells of 5 µm, turned by 0.5 rad."""
    side = 5 * (numpy.arange(20) - 9.5)
    X = numpy.stack(numpy.meshgrid(side, side), axis=-1).reshape(-1, 2)
    turn = numpy.array([[numpy.cos(0.5), -numpy.sin(0.5)],
                        [numpy.sin(0.5), numpy.cos(0.5)]])
    return X @ turn.T, numpy.full(len(X), 25.0)


def motion(results, X, t):
    """Exact positions and gradient: of free growth about the cells' centre, or
    of the affine displacement that the scene prescribes."""
    dim = results.dimension
    if results.keys["Growth/Law"] != "none":
        theta = results.function("Growth/Isotropic/Stretch", X, t)[0]
        centre = X.mean(axis=0)
        return centre + theta * (X - centre), theta * numpy.eye(dim), theta
    key = "Boundary conditions/Displacement"
    u_0, *u = results.function(
        key, numpy.concatenate([numpy.zeros((1, dim)), numpy.eye(dim)]), t)
    F = numpy.eye(dim) + (numpy.array(u) - u_0).T
    return X @ F.T + u_0, F, 1.0


def errors(results):
    cells = results.last_cells()
    dim = results.dimension
    X = initial_positions(cells)[:, :dim]
    x, F, theta = motion(results, X, cells["time"][0])
    V = cells["volume"]
    sigma = cauchy(F[None], lame(), numpy.array([theta]), dim)
    error = norm(stresses(cells) - sigma, V)
    scale = norm(numpy.broadcast_to(sigma, (len(X), 3, 3)), V)
    name = "stress" if scale > 1e-12 else "stress [kPa]"
    return {"displacement": norm(positions(cells)[:, :dim] - x, V)
            / norm(x - X, V),
            name: error / scale if name == "stress" else error}


@ladders(
    Ladder("2d-affine-aligned", PLANE, "Grid/Spacing",
           "box on the grid's lines, L_p = 4 µm", [40, 20], ALIGNED,
           few=(40,), most={"displacement": 1e-8, "stress": 1e-8}),
    Ladder("2d-affine-cells", PLANE, "Tissue/Cell spacing", "h = 20 µm",
           [10, 5, 2.5, 1.25, 0.625], few=(10, 5), least_orders=QUADRATURE),
    Ladder("2d-affine-h", PLANE, "Grid/Spacing", "h/L_p = 8", [40, 20, 10, 5], spacing(8),
           least_orders={"displacement": 0.9}, most={"stress": 0.02}),
    Ladder("2d-rigid", PLANE, "Grid/Spacing", "L_p = 2.5 µm, 4 steps", [27, 13], TURN,
           few=(27,), most=EXACT),
    Ladder("2d-growth", PLANE, "Grid/Spacing", "L_p = 2.5 µm, 4 steps", [27, 13],
           GROW, most=EXACT),
    Ladder("2d-growth-turned-lattice", PLANE, "Grid/Spacing",
           "a square of cells askew in the grid, 4 steps", [27, 13], GROW,
           cells=turned_lattice, few=(27,), most=EXACT),
    Ladder("3d-affine-aligned", SPACE, "Grid/Spacing",
           "box on the grid's lines, L_p = 4 µm", [40, 20], ALIGNED,
           few=(40,), most={"displacement": 1e-8, "stress": 1e-8}),
    Ladder("3d-affine-cells", SPACE, "Tissue/Cell spacing", "h = 20 µm", [10, 5, 2.5, 1.5],
           few=(10, 5), least_orders=QUADRATURE),
    Ladder("3d-rigid", SPACE, "Grid/Spacing", "L_p = 4 µm, 4 steps", [27, 17], TURN, most=EXACT),
    Ladder("3d-growth", SPACE, "Grid/Spacing", "L_p = 4 µm, 4 steps", [27, 17], GROW, most=EXACT))
def test_ladder(case, ladder):
    ladder.climb(case, errors)
