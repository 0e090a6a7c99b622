# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What must hold of every scene: random ones, turned, mirrored, renumbered.

The seed of a scene stands in the names of its trials.
"""
import random

import numpy
from scipy.spatial import cKDTree

from tests.common.results import initial_positions, positions, read_csv
from tests.cases.case import Case, Finding, Limit, Trial
from tests.hard.random_scenes import (AlignedScene, LatticeScene, PointsScene,
                                      quarter_turns_and_mirrors, rotation)

SCENE = "properties.prm"
N_QUICK, N_FULL = 3, 20


class Family:
    """Random scenes of one kind, and the runs of each."""

    def __init__(self, name, make, n_quick, n_full):
        self.name, self.make = name, make
        self.seeds = range(1, n_full + 1)
        self.n_quick = n_quick

    def scene(self, seed):
        return self.make(seed)

    def maps(self, seed):
        """Orthogonal matrices by the names of the runs."""
        rng, dim = random.Random(seed), self.scene(seed).dim
        return {"as-is": numpy.eye(dim),
                "turned": rng.choice(quarter_turns_and_mirrors(dim, 1)),
                "mirrored": rng.choice(quarter_turns_and_mirrors(dim, -1)),
                "any-angle": rotation(rng, dim)}

    def trial_name(self, seed, run):
        return f"{self.name}-seed-{seed}-{run}"

    def trial(self, seed, run, keys, **more):
        return Trial(self.trial_name(seed, run), SCENE, keys=keys,
                     full_only=seed > self.n_quick,
                     row=f"{self.name}, {run}", **more)

    def trials(self):
        for seed in self.seeds:
            scene, maps = self.scene(seed), self.maps(seed)
            if isinstance(scene, LatticeScene):
                for run in ("as-is", "turned", "mirrored"):
                    yield self.trial(seed, run, scene.keys(maps[run]))
            else:
                yield from self._of_points(seed, scene, maps)

    def _of_points(self, seed, scene, maps):
        same, turned = maps["as-is"], maps["any-angle"]
        fine = self.make(seed, 2)
        for run, drawn, Q, order in (
                ("as-is", scene, same, None),
                ("renumbered", scene, same, scene.permutation()),
                ("any-angle", scene, turned, None),
                ("fine", fine, same, None),
                ("fine-any-angle", fine, turned, None)):
            yield self.trial(
                seed, run, drawn.keys(Q),
                files={"cells.csv": drawn.points_file(Q, order)})

    def of(self, runs, run):
        """(seed, its run as it is, the other one) of all seeds that ran."""
        for seed in self.seeds:
            if self.trial_name(seed, run) in runs:
                yield (seed, runs[self.trial_name(seed, "as-is")],
                       runs[self.trial_name(seed, run)])


BOXES = Family("boxes", lambda seed: LatticeScene(seed, 2, True),
               N_QUICK, N_FULL)
BOXES_3D = Family("boxes-3d", lambda seed: LatticeScene(seed, 3, True), 1, 4)
ROUND = Family("round", lambda seed: LatticeScene(seed, 2, False),
               N_QUICK, N_FULL)
ROUND_3D = Family("round-3d", lambda seed: LatticeScene(seed, 3, False), 1, 4)
ALIGNED = Family("aligned", lambda seed: AlignedScene(seed, 2, False),
                 2, N_FULL)
ALIGNED_3D = Family("aligned-3d", lambda seed: AlignedScene(seed, 3, False),
                    1, 4)
PROJECTED = Family("projected", lambda seed: AlignedScene(seed, 2, True),
                   2, N_FULL)
POINTS = Family("points", lambda seed, refinement=1:
                PointsScene(seed, 2, refinement), N_QUICK, N_FULL)
LATTICES = (BOXES, BOXES_3D, ROUND, ROUND_3D, ALIGNED, ALIGNED_3D, PROJECTED)
FAMILIES = (*LATTICES, POINTS)

RENUMBERED = Limit("Cells in another order end within {at_most:g} µm of the "
                   "same places.", at_most=1e-7)
TURNED = Limit("Cells turned by any angle end within {at_most:g} grid "
               "spacings of theirs, turned.", at_most=0.002)
FINER = Limit("Half the spacing of grid and cells leaves at most {at_most:g} "
              "of that.", at_most=0.4)
CONSERVED = Limit("Division neither loses nor wins initial volume, to "
                  "{at_most:g} of it.", at_most=2e-9)


def apart(one, other, Q):
    """The largest distance in µm between the cells of a run and those of
    another one, turned back by Q; infinite if they are not the same cells."""
    a, b = one.results.last_cells(), other.results.last_cells()
    if len(a) != len(b):
        return numpy.inf
    dim = len(Q)
    here, back = positions(a)[:, :dim], positions(b)[:, :dim] @ Q
    # descendants of the same founder, the first of two daughters first
    _, index = cKDTree(initial_positions(b)[:, :dim] @ Q).query(
        initial_positions(a)[:, :dim])
    founders = b["X"][index], b["Y"][index], b["Z"][index]
    i = numpy.lexsort((a["id"], *founders))
    j = numpy.lexsort((b["id"], b["X"], b["Y"], b["Z"]))
    if (a["generation"][i] != b["generation"][j]).any():
        return numpy.inf
    return numpy.linalg.norm(here[i] - back[j], axis=1).max()


def enclosed(surface, dim):
    """Volume that the boundary points enclose, by Gauss's theorem."""
    x = positions(surface)[:, :dim]
    n = numpy.array([surface["nx"], surface["ny"], surface["nz"]]).T[:, :dim]
    return (surface["area"] * ((x - x.mean(axis=0)) * n).sum(axis=1)).sum() / dim


def volume_error(run):
    """How differently cells and boundary points say that the tissue has grown,
    relative to the volume."""
    results = run.results
    cells = [read_csv(file)["volume"].sum() for file in results.outputs("cells")]
    shape = [enclosed(read_csv(file), results.dimension)
             for file in results.outputs("surface")]
    return abs((cells[-1] / cells[0]) / (shape[-1] / shape[0]) - 1)


def volume_not_conserved(run):
    """By division: how far V0 times 2^generation is from the founder's, and
    their sum from that of the founders, relatively."""
    first = read_csv(run.results.outputs("cells")[0])
    last = run.results.last_cells()
    founders = {tuple(cell[["X", "Y", "Z"]]): cell["initial_volume"]
                for cell in first}
    own = numpy.array([founders[tuple(cell[["X", "Y", "Z"]])] for cell in last])
    each = abs(last["initial_volume"] * 2 ** last["generation"] / own - 1).max()
    both = abs(last["initial_volume"].sum() / first["initial_volume"].sum() - 1)
    return max(each, both)


def judge(runs):
    yield from judge_volumes(runs)
    yield from judge_turns(runs)
    yield from judge_points(runs)


def judge_volumes(runs):
    divisions, conserved = 0, 0.0
    for family in LATTICES:
        errors = []
        for seed, run, _ in family.of(runs, "as-is"):
            scene = family.scene(seed)
            errors.append(volume_error(run) / (scene.spacing / scene.size))
            conserved = max(conserved, volume_not_conserved(run))
            divisions += run.results.statistics()["dividing"].sum()
        # One point a cell and flat patches: of first order at a surface that
        # cuts through the lattice, of second order at one along it.
        yield Finding(f"{family.name}: volume of cells against the volume inside "
                      "the surface, over L_p/R", max(errors),
                      at_most=0.002 if family in (BOXES, BOXES_3D) else 0.05)
    yield CONSERVED.found("initial volume lost or won by division, relative",
                          conserved)
    yield Finding("divisions in these scenes", divisions, at_least=100)


def judge_turns(runs):
    for family in LATTICES:
        for name in ("turned", "mirrored"):
            distances = [apart(run, other, family.maps(seed)[name])
                         / family.scene(seed).grid_spacing
                         for seed, run, other in family.of(runs, name)]
            # what the solver leaves, and the tables' digits
            limit = 1e-8 if family in (BOXES, BOXES_3D) else 1e-7
            yield Finding(f"{family.name} {name}: cells apart / h",
                          max(distances), at_most=limit, error=True,
                          trial=f"{family.name}, {name}")


def judge_points(runs):
    ratios, coarse = [], []
    for seed, run, other in POINTS.of(runs, "any-angle"):
        Q, h = POINTS.maps(seed)["any-angle"], POINTS.scene(seed).grid_spacing
        fine = [runs[POINTS.trial_name(seed, name)]
                for name in ("fine", "fine-any-angle")]
        coarse.append(apart(run, other, Q) / h)
        ratios.append(apart(*fine, Q) / h / coarse[-1])
    yield TURNED.found("points turned by any angle: cells apart / h",
                       max(coarse), error=True, trial="points, any-angle")
    yield FINER.found("the same with half the L_p and h, relative to that, "
                      "median", numpy.median(ratios))
    renumbered = [apart(run, other, numpy.eye(2))
                  for _, run, other in POINTS.of(runs, "renumbered")]
    yield RENUMBERED.found("points renumbered: cells apart, µm",
                           max(renumbered), error=True,
                           trial="points, renumbered")


CASE = Case(
    title="Random scenes, turned, mirrored and renumbered",
    judge=judge, limits=(RENUMBERED, TURNED, FINER, CONSERVED),
    trials=[trial for family in FAMILIES for trial in family.trials()])
