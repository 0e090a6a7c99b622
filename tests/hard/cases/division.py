# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that divide where their Voronoi regions are cut, thin or endless."""
import itertools

import numpy
from scipy.spatial import cKDTree

from tests.common.results import positions
from tests.cases.case import Case, Finding, Limit, Trial

LENGTH = 10.0  # of a founder, µm

PLACES = Limit("Daughters stand where formula (6.5) over all pairs of cells "
               "puts them, to {at_most:g} µm.", at_most=1e-5)
WALL = Limit("No daughter is farther behind a held wall than {at_most:g} "
             "cell lengths.", at_most=6e-4)
SURFACE = Limit("None is farther beyond the surface than {at_most:g} cell "
                "lengths.", at_most=0.5)
NEAREST = Limit("No two cells are nearer than {at_least:g} cell lengths.",
                at_least=2.5e-4)


def points_file(points):
    return "x,y,z\n" + "".join("{!r},{!r},{!r}\n".format(*map(float, point))
                               for point in points)


LATTICE = 10.0 * numpy.array(list(itertools.product(range(5), repeat=3)))
FILES = {
    "row.csv": points_file([(10 * i, 0, 0) for i in range(12)]),
    "body-and-fragment.csv": points_file(
        [*LATTICE, (150, 20, 20), (159, 20, 20), (150, 29, 22)]),
    "pair.csv": points_file([*LATTICE, (20.012, 20, 20)]),
    "near-coincident.csv": points_file([*LATTICE, (20 + 1e-12, 20, 20)]),
    "coincident.csv": points_file([*LATTICE, (20, 20, 20)]),
}


def axis_of(run):
    axis = run.results.numbers("Proliferation/Cell cycle/Fixed axis")
    return axis / numpy.linalg.norm(axis)


def families(run):
    """Founders' positions, and those at birth of their two daughters."""
    rows = run.results.lineage()
    place = dict(zip(rows["id"].astype(int), positions(rows)))
    of = {}
    for row in rows:
        if row["generation"] == 1:
            of.setdefault(int(row["parent"]), []).append(int(row["id"]))
    mothers = sorted(of)
    return (numpy.array([place[mother] for mother in mothers]),
            numpy.array([[place[child] for child in sorted(of[mother])]
                         for mother in mothers]))


def half_way(places, axis, length):
    """Distances of daughters by (16), (19), (20) of the paper, from all pairs:
    no search, no diagram."""
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
    return numpy.where(numpy.isfinite(distances), distances,
                       instead[:, None]) / 2


def judge_any(name, run, founders):
    cells = run.results.last_cells()
    V0 = cells["initial_volume"]
    yield Finding(f"{name}: initial volume lost", V0.sum() - founders
                  * LENGTH**3, equals=(0, 0))
    nearest = cKDTree(positions(cells)).query(positions(cells), k=2)[0][:, 1]
    yield NEAREST.found(f"{name}: nearest two cells [lengths]",
                        nearest.min() / LENGTH)
    divisions = run.results.statistics()["dividing"]
    yield Finding(f"{name}: cells at the end", len(cells),
                  equals=(founders + divisions.sum(), 0))


def judge_uniform(name, run):
    """All grow by 1.5 along the axis until they divide at t = 0.5: the tissue
    stretches, without stress, and is a lattice still."""
    axis = axis_of(run)
    mothers, daughters = families(run)
    centre = (0 if "Boundary conditions/Slip where" in run.trial.keys
              else mothers.mean(axis=0))
    stretched = mothers + 0.5 * numpy.outer((mothers - centre) @ axis, axis)
    distances = half_way(stretched, axis, (1.5 * LENGTH**3)**(1 / 3))
    expected = numpy.array([stretched - distances[:, :1] * axis,
                            stretched + distances[:, 1:] * axis])
    error = numpy.abs(daughters.transpose(1, 0, 2) - expected)
    yield PLACES.found(f"{name}: places of daughters against all pairs [µm]",
                       error.max(), error=True, trial=name)
    same = numpy.abs(distances[:, 0] - distances[:, 1]) < 1e-9
    off_centre = daughters[same].mean(axis=1) - stretched[same]
    yield Finding(f"{name}: daughters' middle from the mother, equal walls "
                  "[µm]", numpy.abs(off_centre).max(), at_most=1e-5)


def judge(runs):
    for name, run in runs.items():
        if run.exit != 0:
            continue
        n = int(run.results.statistics()["cells"][0])
        yield from judge_any(name, run, n)
    for name in ("all-at-once", "surface", "row-along", "row-across"):
        yield from judge_uniform(name, runs[name])

    # Daughters stand where the tissue is: half a cell beyond its surface, which
    # is where a founder's own half ends.
    run = runs["surface"]
    _, daughters = families(run)
    r = daughters.reshape(-1, 3) - daughters.reshape(-1, 3).mean(axis=0)
    r[:, 0] /= 1.5
    beyond = numpy.linalg.norm(r, axis=1).max() - 32.0
    yield SURFACE.found("surface: farthest daughter beyond the surface "
                        "[lengths]", beyond / LENGTH)

    # On walls: on the right side, up to 5e-4 lengths (doc/theory.md, 6.5).
    for name in ("wall", "wall-close", "corner", "enclosed"):
        _, daughters = families(runs[name])
        depth = daughters[..., 2 if name.startswith("wall") else slice(None)]
        yield WALL.found(f"{name}: farthest daughter behind a wall [lengths]",
                         max(0.0, -depth.min()) / LENGTH, error=True,
                         trial=name)
        if name == "enclosed":
            yield Finding("enclosed: likewise, opposite walls [lengths]",
                          max(0.0, depth.max() - 40) / LENGTH, at_most=6e-4)

    # The fragment stays a body of its own: three cells made six.
    cells = runs["fragment"].results.last_cells()
    yield Finding("fragment: cells in it", (cells["x"] > 100).sum(),
                  equals=(6, 0))


def from_file(name, file, **more):
    keys = {"Tissue/Shape": "points", "Tissue/Points file": "{files}/" + file,
            **more.pop("keys", {})}
    return Trial(name, "division.prm", files={file: FILES[file]}, keys=keys,
                 **more)


CYCLE = "Proliferation/Cell cycle/"
ACROSS = {CYCLE + "Fixed axis": "0, 0, 1"}
SLIP = {"Boundary conditions/Slip where": "Z <= 0",
        "Boundary conditions/Slip normal": "0, 0, 1", **ACROSS}
FIXED = "Boundary conditions/Fixed where"

CASE = Case(
    title="Division in bad places",
    judge=judge, limits=(PLACES, WALL, SURFACE, NEAREST),
    trials=[
        # three rounds: 64, 128, 256, 512 cells
        Trial("all-at-once", "division.prm", keys={"Time/End time": "2.75"},
              quick={"Time/End time": "1.75"}, ranks=(1, 2)),
        # cells whose axis is tangential to the surface, normal, and between
        Trial("surface", "division.prm",
              keys={"Tissue/Shape": "sphere", "Tissue/Center": "0, 0, 0",
                    "Tissue/Radius": "32"}),
        Trial("wall", "division.prm", keys=SLIP),
        # the lowest cells stand 1e-4 lengths above the wall
        Trial("wall-close", "division.prm",
              keys={**SLIP, "Tissue/Lattice offset": "0, 0, -4.999"}),
        Trial("corner", "division.prm",
              keys={FIXED: "(X <= 0) | (Y <= 0) | (Z <= 0)",
                    CYCLE + "Fixed axis": "1, 1, 1"}),
        Trial("enclosed", "division.prm",
              keys={FIXED: "1", CYCLE + "Division axis": "random",
                    CYCLE + "Fixed axis": "0, 0, 1"}),
        from_file("row-along", "row.csv", keys={"Time/End time": "1.75"}),
        from_file("row-across", "row.csv",
                  keys={**ACROSS, "Time/End time": "1.75"}),
        from_file("fragment", "body-and-fragment.csv",
                  keys={CYCLE + "Division axis": "random",
                        "Time/End time": "0.5"}, ranks=(1, 2)),
        # six cells that grow along axes of their own
        from_file("fragment-later", "body-and-fragment.csv",
                  keys={CYCLE + "Division axis": "random",
                        "Time/End time": "1.75"}),
        from_file("pair", "pair.csv", keys={"Time/End time": "1.75"}),
        from_file("near-coincident", "near-coincident.csv", exit=1,
                  message=r"line 127\).*one cell at each place, in um, and line 64"),
        from_file("coincident", "coincident.csv", exit=1,
                  message=r"line 127\).*one cell at each place, in um, and line 64"),
    ])
