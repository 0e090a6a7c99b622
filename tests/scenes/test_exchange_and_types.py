# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that exchange places, and types of cells: tensions between them, and those
that a file gives."""
import itertools

import numpy
import pytest
from scipy.integrate import trapezoid
from scipy.spatial import cKDTree
from scipy.stats import ncx2

from tests.common.results import agree, positions, read_csv, stresses


@pytest.mark.quick
def test_exchange_shear(scene):
    """A sheared square whose cells exchange places. A cell takes part in k exchanges a
    day, k = 4 D/a^2 on a square lattice, each of which releases all shear at its place.
    So the mean stress falls as the share e^(-kt) of places without any, and the cells
    stand on the same places with the same volumes."""
    a, D, edge = 8, 25, 480
    results = scene({
        "Dimension": 2, "Time/End time": 0.5, "Time/Step": 0.05, "Tissue/Shape": "box",
        "Tissue/Size": f"{edge}, {edge}", "Tissue/Cell spacing": a, "Grid/Spacing": 30,
        "Grid/Offset": "7, 4", "Boundary conditions/Fixed where": 1,
        "Boundary conditions/Displacement": "0.02*Y*min(1, t/0.05); 0",
        "Rearrangement/Diffusion": D, "Output/Interval": 0.05,
        "Solver/Newton tolerance": 1e-6})
    rows = results.statistics()
    outputs = [read_csv(file) for file in results.outputs("cells")]
    first, last = outputs[1], outputs[-1]  # after the first step it is sheared
    n = len(last["id"])
    part = 2 * rows["exchanges"].sum() / n
    agree("exchanges a cell", part / (4 * D / a**2 * last["time"][0]), 1, 0.05)
    # The first output is behind the exchanges of the first step.
    expected = numpy.exp(-2 * rows["exchanges"][2:].sum() / n)
    fall = last["sigma_xy"].mean() / first["sigma_xy"].mean()
    agree("stress over that of the first output", fall / expected, 1, 0.04)
    # No cell has been lost or doubled, and most stand elsewhere.
    places = numpy.round(positions(last)[:, :2], 3)
    assert len(numpy.unique(places, axis=0)) == n
    agree("volume", last["volume"].sum() / edge**2, 1, 1e-3)
    moved = numpy.hypot(last["x"] - last["X"] - 0.02 * last["Y"],
                        last["y"] - last["Y"]) > 0.5 * a
    assert 0.3 < moved.mean() < 0.9


h = 12.5  # grid spacing, um
LIQUID = {"Dimension": 2, "Time/Step": 0.05, "Tissue/Radius": 100,
          "Tissue/Cell spacing": 5, "Grid/Spacing": h, "Grid/Offset": "3, 7",
          "Material/Relaxation time": 0.05,
          "Solver/Newton tolerance": 1e-6}
DROP = {**LIQUID, "Cell types/Names": "around, drop",
        "Cell types/drop/Tension/With around": 1, "Boundary conditions/Slip where": 1}


@pytest.mark.quick
def test_drop_of_a_type(scene):
    """A drop of one type in a round dish of another, both liquid: the pressure in its
    middle is higher by gamma / R (Laplace), times R <1/r> of the diffuse interface:
    the drop's fraction on the splines is the disc smeared out by two quadratic
    splines, of the variance h^2/4 each, taken as one normal distribution."""
    gamma = 1
    results = scene({**DROP, "Time/End time": 0.6,
                     "Cell types/drop/Where": "X^2 + Y^2 < 50^2"})
    cells = results.last_cells()
    r = numpy.linalg.norm(positions(cells)[:, :2], axis=1)
    V, inside = cells["volume"], cells["type"] == 1
    R = (V[inside].sum() / numpy.pi)**0.5
    assert R > 3.9 * h
    pressure = -numpy.einsum("pii->p", stresses(cells)[:, :2, :2]) / 2
    jump = numpy.subtract(*(numpy.average(pressure[part], weights=V[part]) for part in (
        r < 0.4 * R, (r > R + 2 * h) & (r < r.max() - 0.6 * h))))
    r = numpy.linspace(0.001 * R, R + 6 * h, 4000)
    slope = -numpy.gradient(ncx2.cdf(R**2 / (h**2 / 2), 2, r**2 / (h**2 / 2)), r)
    agree("pressure of the drop", jump / (gamma * trapezoid(slope / r, r)), 1, 0.02)


def test_ellipse_of_a_type(scene):
    """A nearly round drop of one type of cells in another, both Maxwell liquids of the
    viscosity eta = mu tau, whatever the step: half the logarithm of its second moments'
    ratio falls at l/(1 + l tau), where l = gamma/(2 R eta) in an unbounded plane, and a
    part of that in a round dish that slips, here 0.772: the solution of two Stokes
    problems with the second mode. The viscosity of the rate l' is eta/(1 - l' tau), as
    the elastic strain falls with the stress. The diffuse, smoothed interface of the
    splines pulls less than a sharp one, never more."""
    gamma, tau = 1, 0.05
    results = scene({**DROP, "Time/End time": 0.4, "Time/Step": 0.01,
                     "Tissue/Radius": 149.27, "Output/Interval": 0.05,
                     "Cell types/drop/Where": "(X/1.05)^2 + (Y*1.05)^2 < 59^2"})
    times, logs = [], []
    for cells in map(read_csv, results.outputs("cells")):
        drop = cells["type"] == 1
        V = cells["volume"][drop]
        moments = numpy.cov(numpy.stack([cells["x"][drop], cells["y"][drop]]),
                            aweights=V)
        small, large = numpy.linalg.eigvalsh(moments)
        times.append(cells["time"][0])
        logs.append(0.5 * numpy.log(large / small))
        R = (V.sum() / numpy.pi)**0.5
    viscous = 0.772 * gamma / (2 * R * results.lame()[1] * tau)
    exact = viscous / (1 + viscous * tau)
    # The stress of the first steps is still elastic.
    rate = -numpy.polyfit(times[2:], numpy.log(logs[2:]), 1)[0]
    print("rate, 1/day:", rate, "exact:", exact)
    assert 0.95 < rate / exact < 1


def circle(places):
    """Centre and radius of the circle with the least squares of |x - c|^2 - R^2."""
    A = numpy.column_stack([2 * places, numpy.ones(len(places))])
    (x, y, c), *_ = numpy.linalg.lstsq(A, (places**2).sum(1), rcond=None)
    return numpy.array([x, y]), (c + x**2 + y**2)**0.5


def contact_angles(cells, surface):
    """Those of the types 0 and 1, degrees, by circles that are fitted to the free
    surfaces two grid spacings away from the interface. That is a straight line, as
    both drops have one pressure: half of the area lies on each of its sides."""
    X, S = (positions(points)[:, :2] for points in (cells, surface))
    nearest = cells["type"][cKDTree(X).query(S)[1]]
    axis = X[cells["type"] == 1].mean(0) - X[cells["type"] == 0].mean(0)
    axis /= numpy.linalg.norm(axis)
    along = X @ axis
    order = numpy.argsort(along)
    half = numpy.cumsum(cells["volume"][order]) / cells["volume"].sum()
    line = numpy.interp(0.5, half, along[order])
    for kind, side in ((0, -1), (1, 1)):
        center, R = circle(S[(nearest == kind) & (abs(S @ axis - line) > 2 * h)])
        assert R > 6 * h
        yield 180 - numpy.degrees(numpy.arccos(side * (center @ axis - line) / R))


def test_angle_between_types(scene):
    """Two liquid drops, left and right, half a disc each, that share an interface:
    with the same tension gamma of both free surfaces and gamma_i of the interface, both
    have the angle 180 - arccos(gamma_i / (2 gamma)) degrees where the three meet
    (Neumann), and keep it."""
    results = scene({
        **LIQUID, "Time/End time": 8,
        "Tissue/Coarsen surface": "true", "Cell types/Names": "left, right",
        "Cell types/left/Tension/With surface": 3, "Cell types/right/Where": "X > 0",
        "Cell types/right/Tension/With left": 3,
        "Cell types/right/Tension/With surface": 3, "Output/Interval": 1})
    found = 0
    for cells, surface in zip(map(read_csv, results.outputs("cells")),
                              map(read_csv, results.outputs("surface"))):
        if cells["time"][0] >= 4:
            found += 1
            agree("angles, degrees", list(contact_angles(cells, surface)), 120, 4)
    assert found >= 3


@pytest.mark.quick
def test_points_phases(scene, runs):
    """Founders begin in the generation, phase and type that their file says, and
    divide when that phase lets them: with T = 2 days and nobody leaving G0, those in S
    in (0.5, 1] day and those in G2 in (0, 0.5], once; nobody else does."""
    n = numpy.arange(125)
    phase, generation = numpy.array([0, 1, 2, 4, 9])[n % 5], n % 4
    names = numpy.array(["stem", "transit", "1"])[n % 3]
    places = itertools.product(range(-20, 30, 10), repeat=3)
    (runs.work / "cells.csv").write_text("x,y,z,generation,phase,type\n" + "".join(
        f"{x},{y},{z},{generation[i]},{phase[i]},{names[i]}\n"
        for i, (z, y, x) in enumerate(places)))
    results = scene({
        "Time/Step": 0.25, "Tissue/Shape": "points",
        "Tissue/Points file": runs.work / "cells.csv",
        "Cell types/Names": "stem, transit",
        "Cell types/stem/Daughter types": "stem, transit", "Grid/Spacing": 35,
        "Proliferation/Law": "cell cycle", "Proliferation/Cell cycle/Duration": 2,
        "Proliferation/Cell cycle/G0 exit rate": 0, "Solver/Newton tolerance": 1e-6})
    first = read_csv(results.outputs("cells")[0])
    assert (first["id"] == n).all()
    assert (first["phase"] == phase).all() and (first["generation"] == generation).all()
    agree("growth at t = 0", first["growth_volume_ratio"], 1, 1e-12)

    lineage = results.lineage()
    founders = lineage[lineage["parent"] < 0]
    types = numpy.isin(names, ["transit", "1"])
    assert (founders["generation"] == generation).all()
    assert (founders["type"] == types).all()
    daughters = lineage[lineage["parent"] >= 0]
    mothers = daughters["parent"].astype(int)
    assert (daughters["generation"] == generation[mothers] + 1).all()
    second = daughters["id"] % 2 == daughters["id"].max() % 2
    assert (daughters["type"] == types[mothers] | second).all()
    for number, begin, end in ((1, 0.5, 1), (2, 0, 0.5)):
        divided = numpy.flatnonzero(phase == number)
        times = daughters["birth_time"][numpy.isin(mothers, divided)]
        assert len(times) == 2 * len(divided)
        assert begin < times.min() and times.max() <= end
        # all over the phase
        assert times.max() - times.min() > 0.6 * (end - begin)
    assert set(phase[mothers]) == {1, 2}

    # Those in G1 grow on, from 1.5 to 2 of a resting cell at most, and rest.
    last = results.last_cells()
    resting = numpy.isin(last["id"], numpy.flatnonzero(phase == 4))
    growth = last["growth_volume_ratio"][resting]
    assert (growth > 1).all() and (growth <= 2 / 1.5 + 1e-9).all()
    assert (last["phase"][resting] == 0).all()
