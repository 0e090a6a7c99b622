# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies that nothing holds, or not enough."""
import math

import numpy

from tests.common.results import initial_positions, positions, read_csv
from tests.cases.case import Case, Finding, Limit, Trial

ANGLES = 0.5, 1.0  # of the turned layouts, radians
SHIFT = 40.0, -60.0  # µm, whole grid cells

STAYS = Limit("In a step, a free body as a whole moves by less than "
              "{at_most:g} µm, and turns by less than that at its rim.",
              at_most=1e-7)
FRAME = Limit("Moved by whole grid cells, or solved directly, its cells are "
              "within {at_most:g} µm of where they were.", at_most=1e-5)
GRID = Limit("With grid lines elsewhere, or turned, they are within "
             "{at_most:g} µm.", at_most=0.05)
FRAGMENT = Limit("A fragment that breaks off grows without stress: its mean "
                 "$J_e$ is {right:g} ± {tolerance:g}.", equals=(1, 2e-3))


def layout(angle=0.0, shift=(0.0, 0.0)):
    """The cells of free-body.prm, turned and shifted, as a file of points."""
    x, y = numpy.meshgrid(numpy.arange(-77.5, 80, 5), numpy.arange(-47.5, 50, 5))
    X = numpy.stack([x.ravel(), y.ravel()], axis=-1) @ turn(angle).T + shift
    return "x,y,volume\n" + "".join(f"{a!r},{b!r},25\n" for a, b in X.tolist())


def turn(angle):
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.array([[c, -s], [s, c]])


def turned(name, angle=0.0, shift=(0.0, 0.0)):
    """free-body.prm turned and shifted as a whole."""
    c, s = math.cos(angle), math.sin(angle)
    X = f"({c!r}*(X - {shift[0]}) + {s!r}*(Y - {shift[1]}))".replace("- -", "+ ")
    Y = f"({c!r}*(Y - {shift[1]}) - {s!r}*(X - {shift[0]}))".replace("- -", "+ ")
    return Trial(name, "free-body.prm", files={"cells.csv": layout(angle, shift)},
                 keys={"Tissue/Shape": "points",
                       "Tissue/Points file": "{files}/cells.csv",
                       "Growth/Isotropic/Stretch":
                           f"1 + 0.2*t*(1 + {X}/80)*(1 + {Y}/100)"})


def block(name, center, size, slip):
    """A part of free-block.prm on slip planes."""
    return Trial(name, "free-block.prm", quick={"Tissue/Cell spacing": "10", "Grid/Spacing": "20"},
                 keys={"Tissue/Center": center, "Tissue/Size": size,
                       "Boundary conditions/Slip where": slip})


def drift(results, members=None):
    """The largest mean displacement of a step and the largest mean rotation
    times the radius of gyration, µm, of the given cells. Growth only."""
    largest, before = [0.0, 0.0], None
    for file in results.outputs("cells"):
        cells = read_csv(file)
        x, V0 = positions(cells), cells["initial_volume"]
        if members is not None:
            x, V0 = x[members], V0[members]
        if before is not None:
            u = x - before
            arms = before - numpy.average(before, axis=0, weights=V0)
            mean = numpy.average(u, axis=0, weights=V0)
            moment = numpy.average(numpy.cross(arms, u), axis=0, weights=V0)
            radius = numpy.sqrt(numpy.average((arms**2).sum(axis=1), weights=V0))
            largest = [max(largest[0], numpy.linalg.norm(mean)),
                       max(largest[1], numpy.linalg.norm(moment) / radius)]
        before = x
    return largest


def farthest(cells, other):
    """The largest distance between equal cells of two runs, paired by their
    initial positions rounded to 0.01 µm."""
    of = {tuple(X): x for X, x in zip(
        numpy.round(initial_positions(other), 2), positions(other))}
    return max(numpy.linalg.norm(x - of[tuple(X)]) for X, x in zip(
        numpy.round(initial_positions(cells), 2), positions(cells))
        if tuple(X) in of)


def judge_body(runs):
    body = {name: run.results for name, run in runs.items()
            if name.startswith("body")}
    for name in ("body", "body-offset", "body-turned-0"):
        mean, rotation = drift(body[name])
        yield STAYS.found(f"{name}: mean displacement of a step [µm]", mean)
        yield STAYS.found(f"{name}: mean rotation of a step times radius [µm]",
                          rotation)
    base = body["body"].last_cells()
    x, J = positions(base)[:, :2], base["elastic_volume_ratio"]
    energy = body["body"].statistics()["mean_energy_density"][-1]
    for name, shift, angle, far, J_far in (
            ("body-direct", (0, 0), 0, FRAME, 1e-7),
            ("body-points", (0, 0), 0, FRAME, 1e-7),
            ("body-shifted", SHIFT, 0, FRAME, 1e-7),
            ("body-offset", (0, 0), 0, GRID, 5e-3),
            ("body-turned-0", (0, 0), ANGLES[0], GRID, 5e-3),
            ("body-turned-1", (0, 0), ANGLES[1], GRID, 5e-3)):
        cells = body[name].last_cells()
        back = (positions(cells)[:, :2] - shift) @ turn(angle)
        yield far.found(f"{name}: cells [µm]",
                        numpy.linalg.norm(back - x, axis=1).max(),
                        error=True, trial=name)
        yield Finding(f"{name}: J_e, root mean square", numpy.sqrt(numpy.mean(
            (cells["elastic_volume_ratio"] - J)**2)), at_most=J_far)
        other = body[name].statistics()["mean_energy_density"][-1]
        yield Finding(f"{name}: mean energy density, relative",
                      abs(other / energy - 1), at_most=10 * J_far)


def judge_block(runs):
    free = runs["block"].results
    energy = free.statistics()["mean_energy_density"][-1]
    h = free.number("Grid/Spacing")
    mean, rotation = drift(free)
    yield Finding("block: mean displacement of a step [µm]", mean, at_most=1e-7)
    yield Finding("block: mean rotation of a step times radius [µm]", rotation,
                  at_most=1e-7)
    for name in ("block-1-plane", "block-2-planes", "block-3-planes"):
        part = runs[name].results
        yield Finding(f"{name}: cells against the free block [µm]",
                      farthest(part.last_cells(), free.last_cells()),
                      at_most=0.2 * (h / 20)**2, error=True, trial=name)
        other = part.statistics()["mean_energy_density"][-1]
        yield Finding(f"{name}: mean energy density, relative",
                      abs(other / energy - 1), at_most=0.04 * (h / 20)**2)


def judge_fragment(runs):
    results = runs["breaking-off"].results
    files = results.outputs("cells")
    last = read_csv(files[-1])
    order = numpy.argsort(last["x"])
    gaps = numpy.flatnonzero(numpy.diff(last["x"][order]) > 60)
    yield Finding("breaking-off: gaps wider than three grid cells", len(gaps),
                  equals=(2, 0))
    if len(gaps) != 2:
        return
    members = numpy.sort(order[gaps[0] + 1:gaps[1] + 1])
    before, fragment = None, []
    for file in files:
        cells = read_csv(file)
        if cells["time"][0] > 0.45:
            x, V0 = positions(cells)[members], cells["initial_volume"][members]
            if before is not None:
                fragment.append(numpy.linalg.norm(numpy.average(
                    x - before, axis=0, weights=V0)))
            before = x
    yield Finding("breaking-off: drift of the fragment in a step [µm]",
                  max(fragment), at_most=1e-7, error=True, trial="breaking-off")
    inside = numpy.flatnonzero(numpy.abs(last["X"]) < 25)
    yield FRAGMENT.found("breaking-off: J_e of the grown fragment, its mean",
                         last["elastic_volume_ratio"][inside].mean())


def judge_pushed(runs):
    """No equilibrium balances the push; forces of inertia do."""
    base = runs["pushed"].results
    x = positions(base.last_cells())
    moved = numpy.linalg.norm(x - initial_positions(base.last_cells()), axis=1)
    yield Finding("pushed: farthest cell [µm]", moved.max(), at_least=5)
    energy = base.statistics()["mean_energy_density"][-1]
    for name, far, energy_far in (("pushed-direct", 1e-6, 1e-8),
                                  ("pushed-offset", 0.3, 5e-3)):
        other = runs[name].results
        yield Finding(f"{name}: cells [µm]", numpy.linalg.norm(
            positions(other.last_cells()) - x, axis=1).max(), at_most=far,
            error=True, trial=name)
        yield Finding(f"{name}: mean energy density, relative", abs(
            other.statistics()["mean_energy_density"][-1] / energy - 1),
            at_most=energy_far)


def judge(runs):
    yield from judge_pushed(runs)
    yield from judge_body(runs)
    yield from judge_block(runs)
    yield from judge_fragment(runs)


CASE = Case(
    title="Bodies that nothing holds",
    judge=judge, limits=(STAYS, FRAME, GRID, FRAGMENT),
    trials=[
        Trial("body", "free-body.prm", ranks=(1, 2), agreement=1e-5),
        Trial("body-direct", "free-body.prm",
              keys={"Solver/Linear solver": "direct"}),
        Trial("body-offset", "free-body.prm", keys={"Grid/Offset": "7, 13"}),
        turned("body-points"),
        turned("body-shifted", shift=SHIFT),
        turned("body-turned-0", angle=ANGLES[0]),
        turned("body-turned-1", angle=ANGLES[1]),
        block("block", "0, 0, 0", "120, 80, 60", ""),
        block("block-1-plane", "0, 0, 15", "120, 80, 30", "Z < 0.1"),
        block("block-2-planes", "30, 0, 15", "60, 80, 30",
              "X < 0.1 || Z < 0.1"),
        block("block-3-planes", "30, 20, 15", "60, 40, 30",
              "X < 0.1 || Y < 0.1 || Z < 0.1"),
        Trial("breaking-off", "breaking-off.prm"),
        Trial("pushed", "pushed-body.prm"),
        Trial("pushed-direct", "pushed-body.prm",
              keys={"Solver/Linear solver": "direct"}),
        Trial("pushed-offset", "pushed-body.prm",
              keys={"Grid/Offset": "7, 13"}),
    ])
