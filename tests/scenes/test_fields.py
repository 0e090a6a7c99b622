# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fields that diffuse and are used up: closed forms."""
import numpy
import pytest

from tests.common.results import agree, initial_positions, read_csv

pytestmark = pytest.mark.quick

ONCE = {"Time/End time": 0.1, "Time/Step": 0.1, "Solver/Newton tolerance": 1e-6}


def ball(name, radius, spacing, points, h, **field):
    """A ball with one field, as keys; those of the field without its name."""
    return {**ONCE, "Tissue/Shape": "sphere", "Tissue/Radius": radius,
            "Tissue/Cell spacing": spacing,
            "Tissue/Boundary points": points, "Grid/Spacing": h, "Fields/Names": name,
            **{f"Fields/{name}/{key}": value for key, value in field.items()}}


def test_dilution(scene):
    """A field that neither diffuses out nor is used up becomes less as tissue grows:
    c = c_0 / J; one without dilution stays."""
    results = scene({
        "Time/Step": 0.25, "Tissue/Shape": "box", "Tissue/Size": "60, 60, 60",
        "Tissue/Cell spacing": 10, "Grid/Spacing": 20, "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.2*t", "Fields/Names": "diluted, kept",
        **{f"Fields/{name}/{key}": value for name in ("diluted", "kept")
           for key, value in (("Time", "transient"), ("Diffusion", 1e3),
                              ("Initial", 2))},
        "Fields/kept/Dilution": "false"})
    cells = results.last_cells()
    J = cells["volume"] / cells["initial_volume"]
    agree("growth", J, 1.2**3, 1e-6)
    agree("the field times J, relative", cells["diluted"] * J / 2, 1, 1e-7)
    agree("the other one", cells["kept"], 2, 1e-7)


def test_first_order(scene):
    """A steady field that is used up at a rate that does not depend on it, in a ball
    of phi = R sqrt(k/D) = 2: sinh(phi r/R) / (r/R sinh(phi))."""
    results = scene(ball("oxygen", 100, 5, 2000, 20, **{
        "Diffusion": 1e8, "Consumption": 4e4, "Fixed where": 1, "Value": 160,
        "Initial": 160}))
    cells = read_csv(results.outputs("cells")[0])
    r = numpy.linalg.norm(initial_positions(cells), axis=1) / 100
    c, phi = cells["oxygen"] / 160, 2
    exact = numpy.sinh(phi * r) / (r * numpy.sinh(phi))
    agree("concentration, relative", c, exact, 6e-3)
    centre = numpy.average(c[r < 0.15] / exact[r < 0.15])
    agree("concentration in the centre, relative", centre * phi / numpy.sinh(phi),
          0.551441, 0.002 * 0.551441)
    agree("mean concentration, relative", numpy.average(c, weights=cells["volume"]),
          0.805972, 0.002 * 0.805972)
    assert results.statistics()["oxygen_clipped"][0] == 0


@pytest.mark.parametrize("R, points, core", [
    (300, 5000, 161.13), pytest.param(400, 9000, 269.46, marks=pytest.mark.check)])
def test_zero_order(scene, R, points, core):
    """A steady field that cells use up at a rate of its own until hardly anything is
    left, in a ball that it enters by r_l = sqrt(6 D c/q) = 200 um: the core gets none,
    R^2 - 3 R_n^2 + 2 R_n^3/R = r_l^2; doc/theory.md (11.5)."""
    results = scene(ball("oxygen", R, 15, points, 40, **{
        "Diffusion": 1.7e8, "Consumption": "4.08e6/(0.5 + oxygen)", "Fixed where": 1,
        "Value": 160, "Initial": 160}))
    cells = read_csv(results.outputs("cells")[0])
    c = cells["oxygen"]
    # Where nothing is used up, nothing is left: by the volume of what is.
    used = numpy.sum(cells["volume"] * c / (0.5 + c))
    found = R * (1 - used / (4 / 3 * numpy.pi * R**3))**(1 / 3)
    agree("radius of the core, um", found, core, 0.02 * core)
    r = numpy.linalg.norm(initial_positions(cells), axis=1)
    agree("what is left in the core", c[r < found - 40], 0, 1.6)
    # Values come out negative only where next to nothing is left: what they are
    # tells nothing, as they are set to 0.
    clipped = results.statistics()["oxygen_clipped"][0]
    agree("share of the cells that were set to 0", clipped / len(cells), 0, 0.01)


def test_flux(scene):
    """A steady field that comes in through the surface of a ball as the same flux
    everywhere, and decays: phi = R sqrt(k/D) = 2,
    c = q R^2 / (D (phi cosh phi - sinh phi)) sinh(phi r/R)/r."""
    R, D, k, q, phi = 100, 2500, 1, 50, 2
    results = scene(ball("signal", R, 5, 2000, 20, **{
        "Diffusion": D, "Consumption": k, "Flux": q, "Flux where": 1}))
    cells = read_csv(results.outputs("cells")[0])
    surface = read_csv(results.outputs("surface")[0])
    r = numpy.linalg.norm(initial_positions(cells), axis=1)
    exact = (q * R**2 / (D * (phi * numpy.cosh(phi) - numpy.sinh(phi)))
             * numpy.sinh(phi * r / R) / r)
    c = cells["signal"]
    agree("the field, relative to its largest value", c / exact.max(),
          exact / exact.max(), 1e-2)
    agree("the field in the centre, relative",
          c[r < 0.15 * R] / exact[r < 0.15 * R], 1, 5e-3)
    agree("what is used up by what comes in",
          k * numpy.sum(cells["volume"] * c) / (q * numpy.sum(surface["area"])), 1,
          1e-8)


def test_walls(scene):
    """A steady field that has a value at one end of a bar and decays over
    sqrt(D/k) = 30 um: cosh((L - x)/30)/cosh(L/30), as nothing passes the other
    walls."""
    length = 200
    results = scene({
        **ONCE, "Dimension": 2, "Tissue/Shape": "box", "Tissue/Center": "100, 20",
        "Tissue/Size": f"{length}, 40", "Tissue/Cell spacing": 2, "Grid/Spacing": 10,
        "Fields/Names": "signal", "Fields/signal/Diffusion": 900,
        "Fields/signal/Consumption": 1, "Fields/signal/Fixed where": "X < 0.001",
        "Fields/signal/Value": 1})
    cells = read_csv(results.outputs("cells")[0])
    exact = numpy.cosh((length - cells["x"]) / 30) / numpy.cosh(length / 30)
    agree("the field", cells["signal"], exact, 2e-3)
    agree("the field far from the surface, relative",
          numpy.log(cells["signal"] / exact)[cells["x"] > 50], 0, 5e-3)


def test_tiny(scene):
    """A fixed value around a ball that is far smaller than a grid cell. There the
    usual penalty does not outweigh the flux; it is raised. Next to nothing is used
    up, so that the field is the value everywhere."""
    results = scene({
        **ONCE, "Tissue/Radius": 10, "Tissue/Cell spacing": 2, "Grid/Spacing": 250,
        "Tissue/Surface cells": "whole",
        "Fields/Names": "oxygen", "Fields/oxygen/Diffusion": 1e8,
        "Fields/oxygen/Consumption": 1, "Fields/oxygen/Fixed where": 1,
        "Fields/oxygen/Value": 160, "Fields/oxygen/Initial": 10})
    agree("the field", results.last_cells()["oxygen"], 160, 1e-4)
    agree("its mean", results.last_cells()["oxygen"].mean(), 159.9999906, 1e-6)
