# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pressures, tensions, tractions and weight, by closed forms: lumens, drops of one
tissue, cells from a file, columns."""
import itertools

import numpy
import pytest
from scipy.integrate import solve_ivp, trapezoid
from scipy.optimize import brentq, fsolve

from tests.common.results import (agree, initial_positions, positions, read_csv, root,
                                  stresses)
from tests.scenes.test_balance_and_free import balance, no_drift

pytestmark = pytest.mark.quick

NOWHERE = numpy.zeros((1, 3))
SURFACE = "Boundary conditions/"


class Shell:
    """A shell (2-D: ring, in plane strain) from the radius A to B. With a = ln r' and
    b = ln r/R, equilibrium dP_r/dR = -(d - 1) (P_r - P_t)/R and compatibility
    db/dR = (exp(a - b) - 1)/R are solved by shooting from the wall of the lumen, where
    b is given, for P_r = 0 outside."""

    def __init__(self, constants, dim, A, B):
        (self.lame_lambda, self.mu), self.dim, self.A, self.B = constants, dim, A, B

    def piola(self, stretch, a, b):
        return (self.mu * (numpy.exp(2 * stretch) - 1)
                + self.lame_lambda * (a + (self.dim - 1) * b)) / numpy.exp(stretch)

    def rates(self, R, state):
        a, b = state
        rate_b = numpy.expm1(a - b) / R
        P_r, P_t = self.piola(a, a, b), self.piola(b, a, b)
        by_a = (2 * self.mu * numpy.exp(2 * a) + self.lame_lambda) / numpy.exp(a) - P_r
        by_b = self.lame_lambda * (self.dim - 1) / numpy.exp(a)
        return [(-(self.dim - 1) * (P_r - P_t) / R - by_b * rate_b) / by_a, rate_b]

    def solved(self, factor):
        """Pressure and motion where the lumen has this part of its volume."""
        b = numpy.log(factor) / self.dim

        def solution(a):
            return solve_ivp(self.rates, (self.A, self.B), [a, b], method="DOP853",
                             rtol=1e-12, atol=1e-14, dense_output=True)

        a = brentq(lambda a: self.piola(*solution(a).y[[0, 0, 1], -1]),
                   -(self.dim - 1) * b - 0.3, 0.3, xtol=1e-14)
        return -self.piola(a, a, b) / numpy.exp((self.dim - 1) * b), solution(a).sol


RING = {"Dimension": 2, "Time/Step": 0.25, "Tissue/Radius": 100,
        "Tissue/Inner radius": 60, "Tissue/Cell spacing": 2.5,
        "Tissue/Surface cells": "trimmed", "Grid/Spacing": 10, "Grid/Offset": "3, 7",
        SURFACE + "Lumen where": "X^2 + Y^2 < 80^2", "Solver/Newton tolerance": 1e-6}
BALL = {"Dimension": 3, "Tissue/Cell spacing": 6, "Grid/Spacing": 20,
        "Grid/Offset": "3, 7, 11", SURFACE + "Lumen where": "X^2 + Y^2 + Z^2 < 80^2"}
# Keys, the tolerances of the pressure and of the places of the cells, relative.
LUMENS = {"ring": ({**RING, SURFACE + "Lumen volume": "1 + t^2/2"}, 0.002, 0.001),
          "gas": ({**RING, SURFACE + "Lumen pressure": "0.5*t"}, 0.005, 0.002),
          "shell": ({**RING, **BALL, SURFACE + "Lumen volume": "1 + t"}, 0.005, 0.003)}


@pytest.mark.parametrize("name", [
    "ring", "gas", pytest.param("shell", marks=pytest.mark.check)])
def test_lumen(scene, name):
    """Around a lumen whose volume is given, or that a gas fills whose pressure
    rises."""
    keys, of_pressure, of_place = LUMENS[name]
    results = scene(keys)
    no_drift(results, "free")
    dim, A, B = results.dimension, 60, 100
    shell = Shell(results.lame(), dim, A, B)
    rows = results.statistics()
    volume = rows["lumen_volume"] / rows["lumen_volume"][0]
    agree("volume of the lumen at t = 0, relative", rows["lumen_volume"][0]
          / (numpy.pi * A**2 if dim == 2 else 4 / 3 * numpy.pi * A**3), 1, 1e-3)
    if name == "gas":
        p0 = 0.5 * rows["time"][-1]
        exact = brentq(lambda V: shell.solved(V)[0] - p0 / V, 1, 5, xtol=1e-12)
        agree("pressure times volume of the gas, relative",
              rows["lumen_pressure"][-1] * volume[-1] / p0, 1, 1e-3)
        agree("volume of the lumen, relative", volume[-1], exact, of_pressure)
    else:
        wanted = numpy.array([results.function(SURFACE + "Lumen volume", NOWHERE, t)[0]
                              for t in rows["time"]])
        agree("volume of the lumen, relative", volume[1:] / wanted[1:], 1, 1e-7)
        exact = wanted[-1]
    pressure, motion = shell.solved(exact)
    agree("pressure, relative", rows["lumen_pressure"][-1] / pressure, 1, of_pressure)
    cells = results.last_cells()
    X, x = initial_positions(cells)[:, :dim], positions(cells)[:, :dim]
    R = numpy.clip(numpy.linalg.norm(X, axis=1), A, B)
    agree("places of the cells, of the radius",
          (x - X * numpy.exp(motion(R)[1])[:, None]) / B, 0, of_place)


DROP = {"Time/Step": 0.5, "Tissue/Radius": 100, "Tissue/Cell spacing": 10,
        "Grid/Spacing": 25, "Grid/Offset": "3, 7, 11",
        SURFACE + "Surface tension": "10*t", "Solver/Newton tolerance": 1e-9}
DROPS = {"ball": DROP,
         # 2.4 times as many as by itself: the same equilibrium.
         "patches": {**DROP, "Tissue/Boundary points": 3000},
         "disc-with-pressure": {
             **DROP, "Dimension": 2, "Tissue/Cell spacing": 4, "Grid/Spacing": 12,
             "Grid/Offset": "3, 7", SURFACE + "Pressure": "0.1*t",
             SURFACE + "Pressure where": 1}}


def squeezed(results, outside):
    """J_e at which the material's stress balances this pressure, a function of it."""
    lame_lambda, mu = results.lame()
    dim = results.dimension
    return root(lambda J: (mu * (J ** (2 / dim) - 1) + lame_lambda * numpy.log(J)) / J
                + outside(J), 0.2, 1.0)


def mean_ratio(cells):
    """The mean of J_e by volume."""
    return (numpy.sum(cells["volume"])
            / numpy.sum(cells["volume"] / cells["elastic_volume_ratio"]))


@pytest.mark.parametrize("name", DROPS)
def test_laplace(scene, name):
    """A free ball (2-D: disc) whose surface has a tension, with a pressure besides or
    without: J_e is everywhere that at which the material's stress balances
    p + (d - 1) gamma / r (Laplace), r = R J_e^(1/d)."""
    tolerance = 0.001
    results = scene(DROPS[name])
    no_drift(results, "free")
    dim = results.dimension
    cells, surface = results.last_cells(), results.last_surface()
    t, R = cells["time"][0], results.number("Tissue/Radius")
    gamma, p = (results.function(SURFACE + key, NOWHERE, t)[0]
                for key in ("Surface tension", "Pressure"))

    def outside(J):
        return p + (dim - 1) * gamma / (R * J ** (1 / dim))

    exact = squeezed(results, outside)
    ratio = exact ** (1 / dim)
    assert ratio < 0.98
    if name == "ball":
        agree("radius over the initial one", ratio, 0.963370, 1e-6)
        agree("pressure inside, kPa", outside(exact), 0.207604, 1e-6)
    agree("mean radius by the cells' volume, relative",
          (mean_ratio(cells) / exact) ** (1 / dim), 1, tolerance)
    r = numpy.linalg.norm(positions(surface)[:, :dim], axis=1)
    agree("mean radius of the surface, relative",
          numpy.average(r, weights=surface["area"]) / (R * ratio), 1, tolerance)
    agree("radius of every patch, relative", r / (R * ratio), 1, 5 * tolerance)
    stress = -numpy.einsum("pii->p", stresses(cells)[:, :dim, :dim]) / dim
    agree("mean pressure, relative", numpy.average(stress, weights=cells["volume"])
          / outside(exact), 1, 10 * tolerance)


def points_file(path, places):
    path.write_text("x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in places))
    return {"Tissue/Shape": "points", "Tissue/Points file": path,
            "Grid/Spacing": 35, "Grid/Offset": "4, 9, 15"}


def test_points_pressure(scene, runs):
    """A ball of cells from a file under a following pressure on the surface that is
    made around them: F_e = J_e^(1/3) I everywhere, and sum V sigma balances the
    pressure on the surface."""
    tolerance, p = 0.002, 0.5
    lattice = numpy.array(list(itertools.product(range(-55, 60, 10), repeat=3)))
    ball = lattice[numpy.linalg.norm(lattice, axis=1) < 60]
    results = scene({
        **points_file(runs.work / "ball.csv", ball), "Time/Step": 0.5,
        SURFACE + "Pressure where": 1, SURFACE + "Pressure": f"{p}*t"})
    balance(results, "free", 3e-4)
    no_drift(results, "free")
    cells, surface = results.last_cells(), results.last_surface()
    exact = squeezed(results, lambda J: p)
    assert exact < 0.8
    agree("mean J_e, relative", mean_ratio(cells) / exact, 1, tolerance)
    agree("J_e of every cell, relative", cells["elastic_volume_ratio"] / exact, 1,
          20 * tolerance)
    pressure = -numpy.einsum("pii->p", stresses(cells)) / 3
    agree("mean pressure, relative",
          numpy.average(pressure, weights=cells["volume"]) / p, 1, 2 * tolerance)
    # The surface is closed: the pressure on it adds up to no force.
    vector = (numpy.array([surface["nx"], surface["ny"], surface["nz"]])
              * surface["area"]).T
    agree("sum a n over the area", numpy.linalg.norm(vector.sum(axis=0))
          / surface["area"].sum(), 0, 1e-3)
    # It stays around the cells.
    enclosed = numpy.einsum("pi,pi", vector, positions(surface)) / 3
    agree("enclosed volume over the cells'", enclosed / cells["volume"].sum(), 1, 0.02)


@pytest.mark.check
def test_points_pulled(scene, runs):
    """A bar of cells from a file, held along its axis at one end by a slip plane and
    pulled at the other: F = diag(a, a, b), tau_zz = b T and tau_xx = 0, where T is the
    force over the cross-section that the cells fill. The force is summed from the
    patches that it acts on, and sum V sigma_zz balances it. The run begins on two
    ranks and goes on on one."""
    tolerance, length, width = 0.01, 120, 80
    side = range(-35, 40, 10)
    bar = itertools.product(side, side, range(5, length, 10))
    keys = {**points_file(runs.work / "bar.csv", bar), "Method": "paper",
            "Time/Step": 0.5, SURFACE + "Slip where": "Z < 1",
            SURFACE + "Slip normal": "0, 0, 1", SURFACE + "Traction where": "Z > 118",
            SURFACE + "Traction": "0; 0; 0.2*t"}
    results = scene({**keys, "Time/End time": 0.5}, ranks=2, then=keys)
    lame_lambda, mu = results.lame()
    cells, surface = results.last_cells(), results.last_surface()
    first = read_csv(results.outputs("surface")[0])
    pulled = first["condition"] == 3
    force = 0.2 * cells["time"][0] * first["area"][pulled].sum()
    T = force / width**2
    # The edges are round, and no part of the end.
    agree("pulled area over the cross-section",
          first["area"][pulled].sum() / width**2, 0.8, 0.1)

    def unbalanced(stretches):
        a, b = stretches
        ln_J = numpy.log(a * a * b)
        return [mu * (a * a - 1) + lame_lambda * ln_J,
                mu * (b * b - 1) + lame_lambda * ln_J - b * T]

    a, b = fsolve(unbalanced, [0.9, 1.2], xtol=1e-13)
    assert b > 1.1
    x = positions(cells)
    middle = abs(cells["Z"] - length / 2) < 31
    slope = numpy.polyfit(cells["Z"][middle], x[middle, 2], 1)[0]
    agree("stretch along, relative", slope / b, 1, tolerance)
    slope = numpy.polyfit(cells["X"][middle], x[middle, 0], 1)[0]
    agree("stretch across, relative", slope / a, 1, tolerance)
    x, sigma = positions(surface), stresses(cells)[:, 2, 2]
    # Beside the round edges points slip along normals of their own.
    held = (surface["condition"] == 2) & (first["nz"] < -0.999)
    assert held.sum() > 20
    agree("held points' height, um", x[held, 2], first["Z"][held], 0.2)
    moment = force * numpy.average(x[pulled, 2], weights=first["area"][pulled])
    agree("sum V sigma_zz, relative", numpy.sum(cells["volume"] * sigma) / moment, 1,
          tolerance)


SPACE = {"Dimension": 3, "Time/Step": 1, "Tissue/Center": "0, 0, 75",
         "Tissue/Size": "60, 60, 150", "Tissue/Cell spacing": 7.5, "Grid/Spacing": 25,
         "Grid/Offset": "7, 3, 10", SURFACE + "Slip where": "Z < 149",
         "Body force/Force density": "0; 0; -5e-3"}
POOLED = {"Method": "consistent", "Grid/Spacing": 20, "Tissue/Cell spacing": 2.5}
FINE = {**POOLED, "Material/Volumetric strain": "pointwise"}


@pytest.mark.parametrize("keys, of_stress, of_settling", [
    ({}, 2.5e-3, 4e-4), (FINE, 1.25e-3, 2e-4), (POOLED, 4e-3, 2e-4),
    pytest.param(SPACE, 1e-2, 2e-3, marks=pytest.mark.check)],
    ids=["h40", "h20", "pooled", "3d"])
def test_self_weight(scene, keys, of_stress, of_settling):
    """A column between slip walls under its own weight, free on top. The first
    Piola-Kirchhoff stress carries the weight above: P(L) =
    mu (L - 1/L) + lambda ln L / L = -b (l0 - Y), where b is the weight per initial
    volume. At half the h and cell spacing half the errors are allowed; in 3-D the
    grid cuts the column."""
    results = scene(keys, "self-weight-h40.prm")
    lame_lambda, mu = results.lame()
    up = results.dimension - 1
    length = results.numbers("Tissue/Size")[up]
    cells = results.last_cells()
    X, weight = initial_positions(cells), 5e-3

    def stretch(height):
        load = -weight * (length - height)
        return root(lambda L: mu * (L - 1 / L) + lame_lambda * numpy.log(L) / L - load,
                    0.05, 1.0)

    Y = X[:, up]
    # sigma_yy = P F_yy / J = P, as the column keeps its width
    error = numpy.abs(stresses(cells)[:, up, up] + weight * (length - Y))
    agree("stress in units of b l0", error.mean() / (weight * length), 0.0, of_stress)
    top = Y == Y.max()
    grid = numpy.linspace(0, Y.max(), 2001)
    settled = trapezoid([1 - stretch(height) for height in grid], grid)
    agree("settling of the top cells, relative",
          (X - positions(cells))[top, up] / settled, 1.0, of_settling)
    sideways = [d for d in range(3) if d != up]
    agree("sideways displacement, um", (positions(cells) - X)[:, sideways], 0.0,
          1e-2 * settled)
