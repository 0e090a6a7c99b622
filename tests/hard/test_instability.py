# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth that ends in buckling, wrinkling and creasing.

The growths at which perfect bodies lose stability are the zeros of the smallest
eigenvalue of the second variation of the energy (1.4) of doc/theory.md. It was found
with elements of degree 8 on the line across layers between slip walls and across
rings, for each number of waves along them, and for the clamped rod with body-fitted
elements of degree 4 in the plane; for the half-space (Biot) it is where the
determinant of its decaying solutions vanishes. Nothing was shared with Morula but the
energy.
"""
import numpy
import pytest

from tests.common.results import read_csv

ROD = 2 * numpy.pi / 400  # wave number of the modes of both rods, 1/µm
RODS = {"rod": (1.0336394440, numpy.sin), "clamped-rod": (1.0327097490, numpy.cos)}
# By the number of (half-)waves.
FILM = {2: 1.0761131607, 3: 1.0655200275, 4: 1.0726183911, 5: 1.0887701739}
RING = {4: 1.3280534251, 5: 1.2831938506, 6: 1.2686941448, 7: 1.2714997177}
HALF_SPACE = 1.9028365831
NO_FORCE = {"Body force/Force density": "0; 0; 0"}


def run(case, name, scene, small, keys=()):
    return case.trial(name, scene, {**dict(keys), **({} if case.full else small)}).results


def rod(case, name, keys=()):
    scene = "clamped-rod.prm" if name == "clamped-rod" else "growing-rod.prm"
    return run(case, name, scene, {"Tissue/Cell spacing": "5", "Grid/Spacing": "20"},
               keys)


def amplitudes(results, kind, shapes, value, place):
    """Growths at a place and amplitudes of the first of the shapes, functions of the
    cells or boundary points, in a least-squares fit to a value of theirs."""
    growths, found = [], []
    for points in map(read_csv, results.outputs(kind)):
        matrix = numpy.stack(shapes(points), axis=-1)
        keep = ~numpy.isnan(matrix[:, 0])
        found.append(numpy.linalg.lstsq(matrix[keep], value(points)[keep],
                                        rcond=None)[0])
        growths.append(growth(results, place, points["time"][0]))
    return numpy.array(growths), numpy.array(found)


def growth(results, place, t):
    names = {"X": place[0], "Y": place[1], "t": t}
    formula = results.keys["Growth/Isotropic/Stretch"].replace("^", "**")
    return eval(formula, {}, names)


def critical(growths, w, smallest, largest):
    """The growth at which the perfect body would buckle, from the amplitudes w of the
    imperfect one: theta = theta_c + a w^2 + b w^4 - c/w."""
    w = numpy.abs(w)
    here = (w > smallest) & (w < largest)
    assert here.sum() >= 5
    matrix = numpy.stack([w[here]**0, w[here]**2, w[here]**4, -1 / w[here]], axis=-1)
    return numpy.linalg.lstsq(matrix, growths[here], rcond=None)[0][0]


def lift(points):
    return points["y"] - points["Y"]


def strain(case, name, found, right, tolerance):
    """A critical growth strain theta_c - 1."""
    case.found(f"{name}: critical strain over theory's {right - 1:.5f}",
               (found - 1) / (right - 1), equals=(1, tolerance))


@pytest.mark.parametrize("name", [
    "rod", pytest.param("clamped-rod", marks=pytest.mark.release)])
def test_rod(case, name):
    """Beyond the critical growth the square of the deflection rises with growth: of an
    inextensible rod (k w)^2/4 of its length is hidden in the wave."""
    right, shape = RODS[name]
    growths, found = amplitudes(
        rod(case, name), "cells",
        lambda points: [shape(ROD * points["X"]), 1 + 0 * points["X"]], lift, (0, 10))
    strain(case, name, critical(growths, found[:, 0], 1e-3, 15), right, 0.03)
    slope = numpy.polyfit(found[-5:, 0]**2, growths[-5:], 1)[0]
    case.found(f"{name}: d theta/d w^2 over k^2/4", slope / (ROD**2 / 4),
               equals=(1, 0.15))


@pytest.mark.release
@pytest.mark.parametrize("name, keys, limits", [
    ("rod-perfect", NO_FORCE, {"at_least": 15}),
    ("rod-perfect-direct", {**NO_FORCE, "Solver/Linear solver": "direct"},
     {"at_most": 1e-3})])
def test_perfect_rod(case, name, keys, limits):
    """It buckles by rounding, or not at all."""
    cells = rod(case, name, keys).last_cells()
    shape = numpy.sin(ROD * cells["X"])
    case.found(f"{name}: deflection [µm]",
               abs((shape * lift(cells)).sum() / (shape**2).sum()), **limits)


@pytest.mark.release
def test_film(case):
    """A stiff film on a soft base wrinkles in the wave that loses stability first."""
    results = run(case, "film", "wrinkling-film.prm", {})

    def shapes(points):
        top = numpy.where(points["Y"] > 19.9, 1.0, numpy.nan)
        return [top * numpy.cos(n * numpy.pi / 400 * (points["X"] + 200))
                for n in range(9)]

    growths, found = amplitudes(results, "surface", shapes, lift, (0, 10))
    wave = 1 + numpy.argmax(numpy.abs(found[-1, 1:]))
    assert wave == min(FILM, key=FILM.get) == 3
    strain(case, "film", critical(growths, found[:, 3], 1e-3, 15), FILM[3], 0.03)


@pytest.mark.release
def test_ring(case):
    """A stiff ring around a core folds likewise."""
    results = run(case, "ring", "growing-ring.prm", {})

    def shapes(points):
        angle = numpy.arctan2(points["Y"], points["X"])
        return [1 + 0 * angle] + [wave(n * angle) for n in range(1, 11)
                                  for wave in (numpy.cos, numpy.sin)]

    growths, found = amplitudes(
        results, "surface", shapes,
        lambda points: numpy.hypot(points["x"], points["y"]), (190, 0))
    found = numpy.hypot(found[:, 1::2], found[:, 2::2])
    wave = 1 + numpy.argmax(found[-1])
    assert wave == min(RING, key=RING.get) == 6
    strain(case, "ring", critical(growths, found[:, 5], 0.02, 15), RING[6], 0.05)


@pytest.mark.release
def test_layer(case):
    """Flat before creases can exist, 1/0.647 for incompressible half-spaces (Hong, Zhao
    & Suo 2009), creased before Biot's instability."""
    results = run(case, "layer", "growing-layer.prm", {})
    depth = []
    for points in map(read_csv, results.outputs("surface")):
        top = points["y"][points["Y"] > 79.9]
        depth.append([growth(results, (0, 10), points["time"][0]),
                      top.max() - top.min()])
    depth = numpy.array(depth)
    creased = depth[depth[:, 1] > 20, 0]
    case.found("layer: growth at which it has creased", creased[0], at_most=HALF_SPACE)
    case.found("layer: depth of its waves at theta = 1.54 [µm]",
               depth[depth[:, 0] <= 1.5401, 1].max(), at_most=0.5)
