# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What must hold of every scene: random ones, turned, mirrored, renumbered. The seed
of a scene stands in the names of its trials."""
import random
from functools import partial

import numpy
import pytest
from scipy.spatial import cKDTree

from tests.common.results import initial_positions, positions, read_csv
from tests.hard.random_scenes import (AlignedScene, LatticeScene, PointsScene,
                                      quarter_turns_and_mirrors, rotation)

# What draws a scene of a seed, and how many seeds at the full size; those in 3-D are
# not in contrib/check.
LATTICES = {"boxes": (partial(LatticeScene, dim=2, gentle=True), 20),
            "boxes-3d": (partial(LatticeScene, dim=3, gentle=True), 4),
            "round": (partial(LatticeScene, dim=2, gentle=False), 20),
            "round-3d": (partial(LatticeScene, dim=3, gentle=False), 4),
            "aligned": (partial(AlignedScene, dim=2, pooled=False), 20),
            "aligned-3d": (partial(AlignedScene, dim=3, pooled=False), 4),
            "pooled": (partial(AlignedScene, dim=2, pooled=True), 20)}
divisions = []  # of all scenes


def maps(seed, dim):
    """Orthogonal matrices by the names of the runs."""
    rng = random.Random(seed)
    return {"turned": rng.choice(quarter_turns_and_mirrors(dim, 1)),
            "mirrored": rng.choice(quarter_turns_and_mirrors(dim, -1)),
            "any-angle": rotation(rng, dim)}


def apart(one, other, Q):
    """The largest distance in µm between the cells of a run and those of another one,
    turned back by Q; infinite if they are not the same cells."""
    a, b = one.last_cells(), other.last_cells()
    if len(a) != len(b):
        return numpy.inf
    dim = len(Q)
    here, back = positions(a)[:, :dim], positions(b)[:, :dim] @ Q
    # descendants of the same founder, the first of two daughters first
    _, index = cKDTree(initial_positions(b)[:, :dim] @ Q).query(
        initial_positions(a)[:, :dim])
    i = numpy.lexsort((a["id"], b["X"][index], b["Y"][index], b["Z"][index]))
    j = numpy.lexsort((b["id"], b["X"], b["Y"], b["Z"]))
    if (a["generation"][i] != b["generation"][j]).any():
        return numpy.inf
    return numpy.linalg.norm(here[i] - back[j], axis=1).max()


def enclosed(surface, dim):
    """Volume that the boundary points enclose, by Gauss's theorem."""
    x = positions(surface)[:, :dim]
    n = numpy.array([surface["nx"], surface["ny"], surface["nz"]]).T[:, :dim]
    return (surface["area"] * ((x - x.mean(axis=0)) * n).sum(axis=1)).sum() / dim


def volume_error(results):
    """How differently cells and boundary points say that the tissue has grown, relative
    to the volume."""
    cells = [read_csv(file)["volume"].sum() for file in results.outputs("cells")]
    shape = [enclosed(read_csv(file), results.dimension)
             for file in results.outputs("surface")]
    return abs((cells[-1] / cells[0]) / (shape[-1] / shape[0]) - 1)


def volume_not_conserved(results):
    """By division: how far V0 times 2^generation is from the founder's, and their sum
    from that of the founders, relatively."""
    first, last = read_csv(results.outputs("cells")[0]), results.last_cells()
    founders = {tuple(cell[["X", "Y", "Z"]]): cell["initial_volume"] for cell in first}
    own = numpy.array([founders[tuple(cell[["X", "Y", "Z"]])] for cell in last])
    each = abs(last["initial_volume"] * 2 ** last["generation"] / own - 1).max()
    both = abs(last["initial_volume"].sum() / first["initial_volume"].sum() - 1)
    return max(each, both)


@pytest.mark.parametrize("name", [
    pytest.param(name, marks=pytest.mark.release if "3d" in name else [])
    for name in LATTICES])
def test_turned_and_mirrored(case, name):
    make, n_seeds = LATTICES[name]
    for seed in range(1, n_seeds + 1) if case.full else (1,):
        scene = make(seed)

        def run(what, Q):
            return case.trial(f"{name}-seed-{seed}-{what}", "properties.prm",
                              scene.keys(Q), row=f"{name}, {what}").results

        results = run("as-is", numpy.eye(scene.dim))
        divisions.append(results.statistics()["dividing"].sum())
        # One point a cell and flat patches: of first order at a surface that cuts
        # through the lattice, of second order at one along it.
        case.found(f"{name}, seed {seed}: volume of cells against the volume inside the "
                   "surface, over L_p/R",
                   volume_error(results) / (scene.spacing / scene.size),
                   at_most=0.002 if "boxes" in name else 0.05)
        case.found(f"{name}, seed {seed}: initial volume lost or won by division, "
                   "relative", volume_not_conserved(results), at_most=2e-9)
        for what in ("turned", "mirrored"):
            Q = maps(seed, scene.dim)[what]
            # what the solver leaves, and the tables' digits
            case.found(f"{name}, seed {seed}, {what}: cells apart / h",
                       apart(results, run(what, Q), Q) / scene.grid_spacing,
                       at_most=1e-8 if "boxes" in name else 1e-7)


@pytest.mark.release
def test_divisions():
    """Those scenes have some."""
    assert sum(divisions) >= 100


def test_points(case):
    """Cells in another order, or turned by any angle; half the spacing of grid and
    cells leaves less than half of the difference."""
    same, ratios = numpy.eye(2), []
    for seed in range(1, 21) if case.full else (1,):
        scene, fine = PointsScene(seed, 2), PointsScene(seed, 2, 2)
        Q, h = maps(seed, 2)["any-angle"], scene.grid_spacing

        def run(what, drawn, Q, order=None):
            return case.trial(f"points-seed-{seed}-{what}", "properties.prm",
                              drawn.keys(Q), {"cells.csv": drawn.points_file(Q, order)},
                              row=f"points, {what}").results

        results = run("as-is", scene, same)
        case.found(f"points, seed {seed}, renumbered: cells apart, µm", apart(
            results, run("renumbered", scene, same, scene.permutation()), same),
            at_most=1e-7)
        coarse = apart(results, run("any-angle", scene, Q), Q) / h
        case.found(f"points, seed {seed}, turned by any angle: cells apart / h", coarse,
                   at_most=0.002)
        ratios.append(apart(run("fine", fine, same), run("fine-any-angle", fine, Q), Q)
                      / h / coarse)
    case.found("points: the same with half the L_p and h, relative to that, median",
               numpy.median(ratios), at_most=0.4)
