# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that divide where their Voronoi regions are cut, thin or endless."""
import itertools

import numpy
import pytest
from scipy.spatial import cKDTree

from tests.common.results import positions

LENGTH = 10.0  # of a founder, µm
LATTICE = 10.0 * numpy.array(list(itertools.product(range(5), repeat=3)))
CELLS = {"row": [(10 * i, 0, 0) for i in range(12)],
         "body-and-fragment": [*LATTICE, (150, 20, 20), (159, 20, 20), (150, 29, 22)],
         "pair": [*LATTICE, (20.012, 20, 20)],
         "near-coincident": [*LATTICE, (20 + 1e-12, 20, 20)],
         "coincident": [*LATTICE, (20, 20, 20)]}

CYCLE = "Proliferation/Cell cycle/"
RANDOM = {CYCLE + "Division axis": "random"}
ACROSS = {CYCLE + "Fixed axis": "0, 0, 1"}
SLIP = {"Boundary conditions/Slip where": "Z <= 0",
        "Boundary conditions/Slip normal": "0, 0, 1", **ACROSS}
FIXED = "Boundary conditions/Fixed where"
LATER = {"Time/End time": "1.75"}


def run(case, name, keys=(), cells=None, **options):
    """What holds of any division: initial volume, numbers, distances."""
    # Daughters stay where their mothers have put them.
    keys, files = {"Tissue/Redistribution": "false", **dict(keys)}, {}
    if cells:
        files["cells.csv"] = "x,y,z\n" + "".join(
            "{!r},{!r},{!r}\n".format(*map(float, place)) for place in CELLS[cells])
        keys.update({"Tissue/Shape": "points",
                     "Tissue/Points file": "{files}/cells.csv"})
    trial = case.trial(name, "division.prm", keys, files, **options)
    if trial.code == 0:
        founders = int(trial.rows["cells"][0])
        last = trial.results.last_cells()
        assert last["initial_volume"].sum() == founders * LENGTH**3
        assert len(last) == founders + trial.rows["dividing"].sum()
        nearest = cKDTree(positions(last)).query(positions(last), k=2)[0][:, 1]
        case.found(f"{name}: nearest two cells [lengths]", nearest.min() / LENGTH,
                   at_least=2.5e-4)
    return trial


def families(trial):
    """Founders' positions, and those at birth of their two daughters."""
    rows = trial.results.lineage()
    place = dict(zip(rows["id"].astype(int), positions(rows)))
    of = {}
    for row in rows[rows["generation"] == 1]:
        of.setdefault(int(row["parent"]), []).append(int(row["id"]))
    mothers = sorted(of)
    return (numpy.array([place[mother] for mother in mothers]),
            numpy.array([[place[child] for child in sorted(of[mother])]
                         for mother in mothers]))


def half_way(places, axis, length):
    """Distances of daughters by (16), (19), (20) of the paper, from all pairs: no
    search, no diagram."""
    distances = numpy.full((len(places), 2), numpy.inf)
    for i, place in enumerate(places):
        r = numpy.delete(places, i, axis=0) - place
        along = r @ axis
        for side, sign in enumerate((-1, 1)):
            beside = sign * along > 1e-9
            walls = (r[beside]**2).sum(axis=1) / (2 * sign * along[beside])
            if walls.size and walls.min() <= length:
                distances[i, side] = walls.min()
    nearer = distances.min(axis=1)
    instead = numpy.where(numpy.isfinite(nearer), nearer, length / 2)
    return numpy.where(numpy.isfinite(distances), distances, instead[:, None]) / 2


def judge_uniform(case, name, trial):
    """All grow by 1.5 along the axis until they divide at t = 0.5: the tissue
    stretches, without stress, and is a lattice still."""
    axis = trial.results.numbers(CYCLE + "Fixed axis")
    axis = axis / numpy.linalg.norm(axis)
    mothers, daughters = families(trial)
    centre = mothers.mean(axis=0)
    stretched = mothers + 0.5 * numpy.outer((mothers - centre) @ axis, axis)
    distances = half_way(stretched, axis, (1.5 * LENGTH**3)**(1 / 3))
    expected = numpy.array([stretched - distances[:, :1] * axis,
                            stretched + distances[:, 1:] * axis])
    error = numpy.abs(daughters.transpose(1, 0, 2) - expected)
    case.found(f"{name}: places of daughters against all pairs [µm]", error.max(),
               at_most=1e-5)
    same = numpy.abs(distances[:, 0] - distances[:, 1]) < 1e-9
    off = daughters[same].mean(axis=1) - stretched[same]
    case.found(f"{name}: daughters' middle from the mother, equal walls [µm]",
               numpy.abs(off).max(), at_most=1e-5)


def test_all_at_once(case):
    """Three rounds: 64, 128, 256, 512 cells."""
    end = {"Time/End time": "2.75" if case.full else "1.75"}
    judge_uniform(case, "all at once", run(case, "all at once", end, ranks=(1, 2)))


@pytest.mark.parametrize("name, keys", [("row-along", {}), ("row-across", ACROSS)])
def test_row(case, name, keys):
    judge_uniform(case, name, run(case, name, {**keys, **LATER}, "row"))


def test_surface(case):
    """Cells whose axis is tangential to the surface, normal, and between. Daughters
    stand where the tissue is: half a cell beyond its surface, which is where a
    founder's own half ends."""
    trial = run(case, "surface", {
        "Tissue/Shape": "sphere", "Tissue/Center": "0, 0, 0", "Tissue/Radius": "32",
        "Tissue/Surface cells": "whole"})
    judge_uniform(case, "surface", trial)
    r = families(trial)[1].reshape(-1, 3)
    r = r - r.mean(axis=0)
    r[:, 0] /= 1.5
    case.found("surface: farthest daughter beyond the surface [lengths]",
               (numpy.linalg.norm(r, axis=1).max() - 32.0) / LENGTH, at_most=0.5)


WALLS = {"wall": SLIP,
         # The lowest cells stand 1e-4 lengths above the wall.
         "wall-close": {**SLIP, "Tissue/Lattice offset": "0, 0, -4.999"},
         "corner": {FIXED: "(X <= 0) | (Y <= 0) | (Z <= 0)",
                    CYCLE + "Fixed axis": "1, 1, 1"},
         "enclosed": {FIXED: "1", **RANDOM, **ACROSS}}


@pytest.mark.parametrize("name", WALLS)
def test_walls(case, name):
    """On the right side, up to 5e-4 lengths (doc/theory.md, 6.5)."""
    _, daughters = families(run(case, name, WALLS[name]))
    depth = daughters[..., 2 if name.startswith("wall") else slice(None)]
    case.found(f"{name}: farthest daughter behind a wall [lengths]",
               max(0.0, -depth.min()) / LENGTH, at_most=6e-4)
    if name == "enclosed":
        case.found("enclosed: likewise, opposite walls [lengths]",
                   max(0.0, depth.max() - 40) / LENGTH, at_most=6e-4)


def test_fragment(case):
    """It stays a body of its own: three cells made six."""
    trial = run(case, "fragment", {**RANDOM, "Time/End time": "0.5"},
                "body-and-fragment", ranks=(1, 2))
    assert (trial.results.last_cells()["x"] > 100).sum() == 6


@pytest.mark.release
def test_later(case):
    """Six cells that grow along axes of their own; two cells very close."""
    run(case, "fragment-later", {**RANDOM, **LATER}, "body-and-fragment")
    run(case, "pair", LATER, "pair")


@pytest.mark.parametrize("cells", ["near-coincident", "coincident"])
def test_coincident(case, cells):
    run(case, cells, cells=cells, exits=(1,),
        message=r"line 127\).*one cell at each place, in um, and line 64")
