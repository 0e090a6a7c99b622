# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue that flows: relaxation, pooled volumes, drops and wounds."""
import numpy
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial import cKDTree

from tests.common.results import agree, positions, read_csv, root, stresses

pytestmark = pytest.mark.quick


def test_relaxation_creep(scene):
    """A bar that is pulled at its end creeps at sigma / (3 eta), eta = mu tau, in
    steps of any length: the flow of a step sees how the bar moved in the one before.
    The first step is the elastic one; what the next ones do not know yet of the creep
    fades within a few steps. The end does not cross a line of the grid."""
    sigma = 2e-4
    results = scene({
        "Time/End time": 32, "Time/Step": 2, "Tissue/Shape": "box",
        "Tissue/Size": "80, 40, 40", "Tissue/Cell spacing": 10, "Grid/Spacing": 20.05,
        "Material/Relaxation time": 1, "Boundary conditions/Slip where": "X < -39.9",
        "Boundary conditions/Traction where": "X > 39.9",
        "Boundary conditions/Traction": f"{sigma}; 0; 0",
        "Solver/Newton tolerance": 1e-11})
    rows = results.statistics()
    length, times = rows["xmax"] - rows["xmin"], rows["time"]
    half = len(times) // 2
    rate = numpy.polyfit(times[half:], numpy.log(length[half:]), 1)[0]
    agree("rate of creep, relative", rate / (sigma / (3 * results.lame()[1])), 1, 0.01)


HELD = {"Method": "paper", "Tissue/Shape": "box", "Tissue/Cell spacing": 10,
        "Grid/Spacing": 20, "Boundary conditions/Fixed where": 1,
        "Solver/Newton tolerance": 1e-11}
# Stretched to 1.5 times the length; after one relaxation time, in 16 steps, the
# largest of b_e is that of the differential equation after 15.5 steps, as the first
# step brings the stretch.
CUBE = {**HELD, "Time/End time": 0.1, "Time/Step": 0.00625,
        "Tissue/Size": "80, 80, 80", "Material/Relaxation time": 0.1,
        "Contraction/Stretch": "1/1.5", "Contraction/Direction": "0; 0; 1",
        "Output/Interval": 0.025}
# Flows above a yield stress only, ever more slowly, each step cut into three.
YIELDING = {**HELD, "Dimension": 2, "Time/Step": 0.05, "Tissue/Size": "80, 80",
            "Material/Law": "isochoric neo-Hookean", "Material/Young's modulus": 3,
            "Material/Energy per": "grown volume", "Output/Interval": 0.1,
            "Material/Relaxation time": "0.1*exp(t)", "Material/Yield stress": 0.6,
            "Material/Relaxation passes": 3, "Contraction/Direction": "1; 0",
            "Contraction/Keep volume": "false",
            "Contraction/Stretch": "1 - 0.4*min(t/0.2, 1)"}


class Held:
    """The elastic strain of held tissue that contracts along an axis, and flows.

    F = I, and F_g = diag(a) diag(r) of contraction and relaxation. In each step
    F_e = diag(1 / (a r)) loses what the relaxation time of the step's middle lets it
    lose of its shear: a mean of that with the contraction of the step's beginning and
    of its end. With a yield stress, one of the true stress, in 2-D of its deviator in
    the plane, the end alone counts, and it is lost by backward Euler."""

    def __init__(self, results, axis):
        self.results, self.axis, self.dim = results, axis, results.dimension
        self.dt = results.number("Time/Step")
        self.yielding = results.number("Material/Yield stress")
        self.passes = int(results.keys["Material/Relaxation passes"])

    def value(self, key, t):
        return self.results.function(key, numpy.ones((1, 3)), t)[0]

    def contraction(self, t):
        """The diagonal of F_a, three entries."""
        gamma = self.value("Contraction/Stretch", t)
        a = numpy.ones(3)
        if self.results.keys["Contraction/Keep volume"] == "true":
            a[:self.dim] = gamma ** (-1 / (self.dim - 1))
        a[self.axis] = gamma
        return a

    def stress(self, b_e):
        """The true stress."""
        grown = self.results.per_grown_volume()
        return (1 / numpy.sqrt(b_e.prod()) if grown else 1) * self.results.stress_of(b_e)

    def shear(self, b_e):
        """The von Mises stress of the deviator in the space that flows."""
        sigma = self.stress(b_e)[:self.dim]
        return numpy.sqrt(1.5 * ((sigma - sigma.mean()) ** 2).sum())

    def isochoric(self, b_e):
        return b_e[:self.dim] / numpy.prod(b_e[:self.dim]) ** (1 / self.dim)

    def after(self, b_e, ratio):
        """b_e after a step with g = ratio."""
        change = 1 / (1 + ratio * self.isochoric(b_e))
        result = b_e.copy()
        result[:self.dim] *= change / numpy.prod(change) ** (1 / self.dim)
        return result

    def relaxed(self, b_e, tau):
        if self.yielding == 0:
            c = self.isochoric(b_e)
            flow = solve_ivp(lambda _, g: [numpy.prod(1 / c + g) ** (1 / self.dim)],
                             (0, self.dt / tau), [0.0], rtol=1e-12, atol=1e-14)
            return self.after(b_e, flow.y[0, -1])
        for _ in range(self.passes):
            whole = self.dt / self.passes / tau
            if self.shear(b_e) <= self.yielding:
                continue
            start = b_e
            ratio = root(lambda r: r - whole * (
                1 - self.yielding / self.shear(self.after(start, r))), 0.0, whole)
            b_e = self.after(b_e, ratio)
        return b_e

    def strains(self):
        """b_e at the end of each step."""
        dt, r = self.dt, numpy.ones(3)
        for step in range(1, round(self.results.number("Time/End time") / dt) + 1):
            tau = self.value("Material/Relaxation time", (step - 0.5) * dt)
            weight = (1 if self.yielding > 0 else
                      1 / -numpy.expm1(-dt / tau) - tau / dt)
            end = 1 / (self.contraction(step * dt) * r)
            begin = 1 / (self.contraction((step - 1) * dt) * r) if step > 1 else 1
            before = (weight * end + (1 - weight) * begin) ** 2
            D = numpy.sqrt(before / self.relaxed(before, tau))
            r *= D
            yield step, (end / D) ** 2


@pytest.mark.parametrize("keys, axis", [(CUBE, 2), (YIELDING, 0)],
                         ids=["held", "yield-2d"])
def test_relaxation(scene, keys, axis):
    """Tissue that is held on all sides, while its cells contract along an axis."""
    results = scene(keys)
    held = Held(results, axis)
    files = {round(cells["time"][0] / held.dt): cells
             for cells in map(read_csv, results.outputs("cells"))}
    shears = []
    for step, b_e in held.strains():
        shears.append(held.shear(b_e))
        if step in files:
            agree(f"stress at step {step}, kPa", stresses(files[step]),
                  numpy.diag(held.stress(b_e)), 1e-7)
            agree("J_e", files[step]["elastic_volume_ratio"], numpy.sqrt(b_e.prod()),
                  1e-9)
    assert len(files) >= 5 and max(shears) > 1.1 * shears[-1] > 0
    if held.yielding > 0:
        assert held.yielding < shears[-1] < 1.1 * held.yielding
    else:
        agree("largest b_e", b_e.max(), 1.30294944, 0.002)


@pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.check)])
def test_pooled_volume_is_the_sum(scene, dim):
    """Free tissue of which every second cell shrinks to 5 % of its volume, as dying
    cells do: the tissue has the sum of its cells' grown volumes, 0.525 of that at
    first, to the order of the step, and every cell its own. In the plane some cells
    are on grid lines, which share them."""
    waves = "*".join(f"sin(pi*{x}/10)" for x in "XYZ"[:dim])
    results = scene({
        "Dimension": dim, "Time/Step": 0.05, "Tissue/Shape": "box",
        "Tissue/Size": "100, 100, 100", "Tissue/Cell spacing": 10,
        "Tissue/Boundary points": 0, "Grid/Spacing": 20,
        "Grid/Offset": "5, 5" if dim == 2 else "0, 0, 0",
        "Material/Relaxation time": 0.02, "Material/Energy per": "grown volume",
        "Material/Volumetric strain": "pooled", "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": f"(1 - 0.95*t*({waves} > 0))^(1/{dim})",
        "Solver/Newton tolerance": 1e-6})
    cells = results.last_cells()
    shrunk = cells["growth_volume_ratio"] < 0.5
    agree("share of cells that shrink", shrunk.mean(), 0.5, 1e-12)
    ratio = cells["volume"] / cells["initial_volume"]
    total = cells["volume"].sum()
    agree("volume", total / cells["initial_volume"].sum(), 0.525, 0.005)
    agree("mean volume of cells that shrink", ratio[shrunk].mean(), 0.05, 0.0015)
    agree("mean volume of the others", ratio[~shrunk].mean(), 1, 0.01)
    agree("volume of the tissue", results.statistics()[-1]["total_volume"], total,
          1e-9 * total)


def test_flowing_drop(scene):
    """An ellipse that flows rounds up under its surface tension, and stays round: its
    surface stays around the cells for as long as it flows. Sum of a n.x / 2 over the
    volume of the cells, relative to what it was at t = 0, in each output; the same
    from the columns of statistics.csv, and the distance of points from their cells."""
    h = 20
    results = scene({
        "Dimension": 2, "Time/End time": 4, "Time/Step": 0.05,
        "Tissue/Shape": "ellipsoid", "Tissue/Size": "240, 120",
        "Tissue/Cell spacing": 5, "Tissue/Refine surface": "true", "Grid/Spacing": h,
        "Material/Relaxation time": 0.1, "Material/Volumetric strain": "pooled",
        "Boundary conditions/Surface tension": 6, "Output/Interval": 0.5,
        "Solver/Newton tolerance": 1e-6})
    rows = results.statistics()
    shares = []
    for cells, surface in zip(map(read_csv, results.outputs("cells")),
                              map(read_csv, results.outputs("surface"))):
        row = rows[numpy.isclose(rows["time"], cells["time"][0])][-1]
        x, centres = (positions(table)[:, :2] for table in (surface, cells))
        vectors = numpy.stack([surface["area"] * surface[n] for n in ("nx", "ny")], 1)
        middle = numpy.average(x, axis=0, weights=surface["area"])
        enclosed = (vectors * (x - middle)).sum() / 2
        shares.append(enclosed / cells["volume"].sum())
        away = cKDTree(centres).query(x)[0].max()
        assert abs(row["enclosed_volume"] / enclosed - 1) < 1e-6
        assert abs(row["surface_distance"] / away - 1) < 1e-6
    assert len(shares) > 2
    column = rows["enclosed_volume"] / rows["total_volume"]
    assert abs(column / column[0] - 1).max() < 0.02
    assert rows["surface_distance"].max() < 0.5 * h
    radii = numpy.linalg.norm(x - middle, axis=1) / (enclosed / numpy.pi)**0.5
    assert abs(radii - 1).max() < 0.04


@pytest.mark.check
def test_wound(scene):
    """A round hole of radius a in a disc of radius R that flows, with a tension of
    its edge, a purse string: v = A/r with the constant pressure 2 eta A / R^2, so that
    da/dt = -gamma / (2 eta (1 - a^2/R^2)), eta = mu tau, in steps of a fifth of tau."""
    gamma, tau = 2, 0.1
    results = scene({
        "Dimension": 2, "Time/End time": 0.8, "Time/Step": 0.02,
        "Tissue/Shape": "sphere", "Tissue/Radius": 250, "Tissue/Inner radius": 60,
        "Tissue/Cell spacing": 4, "Tissue/Surface cells": "trimmed",
        "Tissue/Refine surface": "true", "Tissue/Coarsen surface": "true",
        "Grid/Spacing": 14,
        "Material/Poisson's ratio": 0.45, "Material/Relaxation time": tau,
        "Material/Volumetric strain": "pooled",
        "Boundary conditions/Surface tension where": "X^2 + Y^2 < 100^2",
        "Boundary conditions/Surface tension": gamma, "Output/Interval": 0.1,
        "Solver/Newton tolerance": 1e-6})
    eta = results.lame()[1] * tau
    rows = []
    for surface in map(read_csv, results.outputs("surface")):
        radius = numpy.hypot(surface["x"], surface["y"])
        of_hole = radius < 130
        rows.append([surface["time"][0], *(
            numpy.average(radius[part], weights=surface["area"][part])
            for part in (of_hole, ~of_hole))])
    times, inner, outer = numpy.array(rows).T
    # The elastic part of the first steps is not of the flow.
    begin = numpy.flatnonzero(times > 0.15)[0]
    exact = gamma / (2 * eta) / (1 - (inner / outer)**2)[begin:]
    speed = (inner[begin] - inner[-1]) / (times[-1] - times[begin])
    agree("speed of the edge, relative", speed / exact.mean(), 1, 0.02)
