# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies that nothing holds, or not enough."""
import math

import numpy
import pytest

from tests.common.results import initial_positions, positions, read_csv

DIRECT = {"Solver/Linear solver": "direct"}
OFFSET = {"Grid/Offset": "7, 13"}


def turn(angle):
    c, s = numpy.cos(angle), numpy.sin(angle)
    return numpy.array([[c, -s], [s, c]])


def layout(angle, shift):
    """The cells of free-body.prm, turned and shifted, as a file of points."""
    x, y = numpy.meshgrid(numpy.arange(-77.5, 80, 5), numpy.arange(-47.5, 50, 5))
    X = numpy.stack([x.ravel(), y.ravel()], axis=-1) @ turn(angle).T + shift
    return "x,y,volume\n" + "".join(f"{a!r},{b!r},25\n" for a, b in X.tolist())


def turned(angle, shift):
    """Keys of free-body.prm turned and shifted as a whole."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = (f"({axis} - ({by}))" for axis, by in zip("XY", shift))
    return {"Tissue/Shape": "points", "Tissue/Points file": "{files}/cells.csv",
            "Growth/Isotropic/Stretch":
                f"1 + 0.2*t*(1 + ({c!r}*{x} + {s!r}*{y})/80)"
                f"*(1 + ({c!r}*{y} - {s!r}*{x})/100)"}


def drift(results):
    """The largest mean displacement of a step and the largest mean rotation times the
    radius of gyration, µm. Growth only."""
    largest, before = numpy.zeros(2), None
    for cells in map(read_csv, results.outputs("cells")):
        x, V0 = positions(cells), cells["initial_volume"]
        if before is not None:
            u, arms = x - before, before - numpy.average(before, axis=0, weights=V0)
            mean = numpy.average(u, axis=0, weights=V0)
            moment = numpy.average(numpy.cross(arms, u), axis=0, weights=V0)
            radius = numpy.sqrt(numpy.average((arms**2).sum(axis=1), weights=V0))
            largest = numpy.maximum(largest, [numpy.linalg.norm(mean),
                                              numpy.linalg.norm(moment) / radius])
        before = x
    return largest


def stays(case, name, results):
    for what, value in zip(("displacement", "rotation times radius"), drift(results)):
        case.found(f"{name}: mean {what} of a step [µm]", value, at_most=1e-7)


@pytest.fixture(scope="module")
def body(case):
    """The free body as it is."""
    results = case.trial("body", "free-body.prm", ranks=(1, 2), agreement=1e-5).results
    stays(case, "body", results)
    return results


# Keys, angle, shift by whole grid cells; how far off cells and J_e may be.
SAME, NEAR = (1e-5, 1e-7), (0.05, 5e-3)
BODIES = {"direct": (DIRECT, None, (0, 0), SAME), "points": ({}, 0, (0, 0), SAME),
          "shifted": ({}, 0, (40.0, -60.0), SAME), "offset": (OFFSET, None, (0, 0), NEAR),
          "turned": ({}, 0.5, (0, 0), NEAR), "turned far": ({}, 1.0, (0, 0), NEAR)}


@pytest.mark.parametrize("name", [
    name if name == "turned" else pytest.param(name, marks=pytest.mark.release)
    for name in BODIES])
def test_body(case, body, name):
    """Moved by whole grid cells, or solved directly, its cells are where they were;
    with grid lines elsewhere, or turned, they are near."""
    keys, angle, shift, (far, J_far) = BODIES[name]
    files = {}
    if angle is not None:
        keys, files = turned(angle, shift), {"cells.csv": layout(angle, shift)}
    results = case.trial(name, "free-body.prm", keys, files).results
    if name in ("offset", "turned"):
        stays(case, name, results)
    base, cells = body.last_cells(), results.last_cells()
    back = (positions(cells)[:, :2] - shift) @ turn(angle or 0)
    case.found(f"{name}: cells [µm]", numpy.linalg.norm(
        back - positions(base)[:, :2], axis=1).max(), at_most=far)
    off = cells["elastic_volume_ratio"] - base["elastic_volume_ratio"]
    case.found(f"{name}: J_e, root mean square", numpy.sqrt(numpy.mean(off**2)),
               at_most=J_far)
    energy, other = (of.statistics()["mean_energy_density"][-1]
                     for of in (body, results))
    case.found(f"{name}: mean energy density, relative", abs(other / energy - 1),
               at_most=10 * J_far)


BLOCKS = {"1 plane": ("0, 0, 15", "120, 80, 30", "Z < 0.1"),
          "2 planes": ("30, 0, 15", "60, 80, 30", "X < 0.1 || Z < 0.1"),
          "3 planes": ("30, 20, 15", "60, 40, 30", "X < 0.1 || Y < 0.1 || Z < 0.1")}


def farthest(cells, other):
    """The largest distance between equal cells of two runs, paired by their initial
    positions rounded to 0.01 µm."""
    of = {tuple(X): x for X, x in zip(numpy.round(initial_positions(other), 2),
                                      positions(other))}
    return max(numpy.linalg.norm(x - of[tuple(X)]) for X, x in zip(
        numpy.round(initial_positions(cells), 2), positions(cells)) if tuple(X) in of)


@pytest.mark.release
def test_block(case):
    """Parts of a free block on slip planes."""
    def run(name, center, size, slip):
        return case.trial(f"block, {name}", "free-block.prm", {
            "Tissue/Center": center, "Tissue/Size": size,
            "Boundary conditions/Slip where": slip}).results

    free = run("free", "0, 0, 0", "120, 80, 60", "")
    energy = free.statistics()["mean_energy_density"][-1]
    h = free.number("Grid/Spacing")
    stays(case, "block", free)
    for name in BLOCKS:
        part = run(name, *BLOCKS[name])
        case.found(f"{name}: cells against the free block [µm]",
                   farthest(part.last_cells(), free.last_cells()),
                   at_most=0.2 * (h / 20)**2)
        other = part.statistics()["mean_energy_density"][-1]
        case.found(f"{name}: mean energy density, relative", abs(other / energy - 1),
                   at_most=0.04 * (h / 20)**2)


@pytest.mark.release
def test_breaking_off(case):
    """A fragment that breaks off stays and grows without stress."""
    files = case.trial("breaking-off", "breaking-off.prm").results.outputs("cells")
    last = read_csv(files[-1])
    order = numpy.argsort(last["x"])
    gaps = numpy.flatnonzero(numpy.diff(last["x"][order]) > 60)
    assert len(gaps) == 2, "gaps wider than three grid cells"
    members = numpy.sort(order[gaps[0] + 1:gaps[1] + 1])
    late = [cells for cells in map(read_csv, files) if cells["time"][0] > 0.45]
    moved = [numpy.linalg.norm(numpy.average(
        positions(now)[members] - positions(before)[members], axis=0,
        weights=now["initial_volume"][members])) for before, now in zip(late, late[1:])]
    case.found("breaking-off: drift of the fragment in a step [µm]", max(moved),
               at_most=1e-7)
    inside = numpy.abs(last["X"]) < 25
    case.found("breaking-off: J_e of the grown fragment, its mean",
               last["elastic_volume_ratio"][inside].mean(), equals=(1, 2e-3))


@pytest.mark.release
def test_pushed(case):
    """No equilibrium balances the push; forces of inertia do."""
    base = case.trial("pushed", "pushed-body.prm")
    cells = base.results.last_cells()
    moved = numpy.linalg.norm(positions(cells) - initial_positions(cells), axis=1)
    case.found("pushed: farthest cell [µm]", moved.max(), at_least=5)
    for name, keys, far, energy_far in (("direct", DIRECT, 1e-6, 1e-8),
                                        ("offset", OFFSET, 0.3, 5e-3)):
        other = case.trial(f"pushed, {name}", "pushed-body.prm", keys)
        off = positions(other.results.last_cells()) - positions(cells)
        case.found(f"pushed, {name}: cells [µm]", numpy.linalg.norm(off, axis=1).max(),
                   at_most=far)
        case.found(f"pushed, {name}: mean energy density, relative", abs(
            other.last("mean_energy_density") / base.last("mean_energy_density") - 1),
            at_most=energy_far)
