# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue smaller than what the grid resolves: clusters, rods, sheets, necks; and
bodies close by."""
import numpy
import pytest

from tests.common.results import initial_positions, positions

SHAPES = {"1 cell": "10, 10, 10", "2 cells": "20, 10, 10", "8 cells": "20, 20, 20",
          "27 cells": "30, 30, 30", "rod of 1 x 1 cells": "200, 10, 10",
          "rod of 2 x 2 cells": "200, 20, 20", "sheet of 1 cell": "200, 200, 10",
          "sheet of 2 cells": "200, 200, 20", "sheet of 4 cells": "200, 200, 40"}
OFFSETS = ("3, 14, 22", "0, 0, 0", "25, 25, 25")  # anyhow, on a line, between


def off(points, theta, centre):
    """Largest distance (µm) from the exact positions of free growth."""
    exact = centre + theta * (initial_positions(points) - centre)
    return numpy.abs(positions(points) - exact).max()


@pytest.mark.parametrize("shape", [
    shape if shape in ("1 cell", "sheet of 1 cell") else
    pytest.param(shape, marks=pytest.mark.release) for shape in SHAPES])
def test_pieces(case, shape):
    """Small and thin pieces that grow evenly by half keep their exact shape, wherever
    the grid's lines lie. Nothing holds a row of single cells against turning about its
    line."""
    of_cells, of_surface = [], []
    for offset in OFFSETS if case.full else OFFSETS[:1]:
        results = case.trial(f"{shape}, {offset}", "small-and-thin.prm", {
            "Tissue/Size": SHAPES[shape], "Grid/Offset": offset}, row=shape).results
        cells = results.last_cells()
        centre = initial_positions(cells).mean(axis=0)
        of_cells.append(off(cells, 1.5, centre))
        of_surface.append(off(results.last_surface(), 1.5, centre))
    row = shape == "rod of 1 x 1 cells"
    case.found(f"{shape}: cells are off by [µm]", max(of_cells), at_most=1e-5)
    case.found(f"{shape}: the surface is off by [µm]", max(of_surface),
               at_most=1e-4 if row else 1e-5)


def test_strip(case):
    """A thin strip bends to its exact arc: exp(a Y) takes a straight strip to
    w = i/a exp(-i a z)."""
    a = 0.004
    for offset in ("0, 0", "10, 20", "7, 13", "0, 31") if case.full else ("7, 13",):
        cells = case.trial(f"strip {offset}", "thin-strip.prm", {"Grid/Offset": offset},
                           row="thin strip that bends").results.last_cells()
        z = numpy.array([1, 1j]) @ initial_positions(cells)[:, :2].T
        w = 1j / a * (numpy.exp(-1j * a * z) - 1)
        exact = numpy.stack([w.real, w.imag], axis=1)
        # Moved rigidly as near to it as possible.
        x, exact = (v - v.mean(axis=0) for v in (positions(cells)[:, :2], exact))
        U, _, V = numpy.linalg.svd(x.T @ exact)
        turn = U @ numpy.diag([1, numpy.linalg.det(U @ V)]) @ V
        case.found("the strip is off the arc by [µm]",
                   numpy.linalg.norm(x @ turn - exact, axis=1).max(), at_most=0.3)


def block(first, last):
    """Centres of cells of 10 µm that fill a box."""
    axes = [numpy.arange(a + 5, b, 10.0) for a, b in zip(first, last)]
    return numpy.stack(numpy.meshgrid(*axes), axis=-1).reshape(-1, len(axes))


def points_file(*blocks):
    X = numpy.concatenate(blocks)
    return ",".join("xyz"[:X.shape[1]]) + "\n" + "\n".join(
        ",".join(f"{value:g}" for value in row) for row in X) + "\n"


def two_blocks(gap):
    return points_file(block((-150, 0), (0, 150)), block((gap, 0), (gap + 150, 150)))


def bodies(case, name, cells, offset="0, 0"):
    return case.trial(name, "close-bodies.prm", {
        "Tissue/Points file": "{files}/cells.csv", "Grid/Offset": offset},
        {"cells.csv": cells}, ranks=(1, 2)).results.last_cells()


# At 60, the grid's lines leave one layer of grid cells empty.
@pytest.mark.parametrize("gap, offset", [
    (60, "10, 0"), pytest.param(110, "0, 0", marks=pytest.mark.release)])
def test_two_bodies(case, gap, offset):
    """A body stays when another one grows behind an empty layer of grid cells."""
    cells = bodies(case, f"gap of {gap} µm", two_blocks(gap), offset)
    left = cells["X"] < 0
    centre = initial_positions(cells)[left].mean(axis=0)
    case.found(f"gap of {gap} µm: the growing body is off by [µm]",
               off(cells[left], 1.1, centre), at_most=1e-5)
    case.found(f"gap of {gap} µm: the other one moves by [µm]",
               off(cells[~left], 1.0, centre), at_most=1e-9)


def test_bodies_in_touching_grid_cells(case):
    """They pull each other."""
    cells = bodies(case, "gap of 20 µm", two_blocks(20))
    case.found("gap of 20 µm: the other one is pulled along by [µm]",
               off(cells[cells["X"] > 0], 1.0, 0), at_least=0.1)


@pytest.mark.release
def test_chain(case):
    """Two blocks joined by a chain of single cells."""
    cells = bodies(case, "chain", points_file(
        block((-150, -50), (-50, 50)), block((-50, 0), (50, 10)),
        block((50, -50), (150, 50))))
    head = cells["X"] < -80
    case.found("block on a chain: growth ratio", (
        cells["volume"][head] / cells["initial_volume"][head]).mean(),
        equals=(1.21, 0.01))


def dumbbell(n=24):
    """A closed surface of revolution about x, as OFF text."""
    x = numpy.concatenate([-60 - 60 * numpy.cos(numpy.linspace(0, 2.6, 14)),
                           60 + 60 * numpy.cos(numpy.linspace(2.6, 0, 14))])
    r = 60 * numpy.sin(numpy.linspace(0, 2.6, 14))
    r = numpy.maximum(numpy.concatenate([r, r[::-1]]), 8)
    phi = 2 * numpy.pi * numpy.arange(n) / n
    points = [(x[0], 0, 0), *((xi, ri * numpy.cos(p), ri * numpy.sin(p))
                              for xi, ri in zip(x[1:-1], r[1:-1]) for p in phi),
              (x[-1], 0, 0)]
    last, rings = len(points) - 1, len(x) - 2

    def ring(k, j):
        return 1 + k * n + j % n

    faces = []
    for j in range(n):
        faces += [(0, ring(0, j + 1), ring(0, j)),
                  (last, ring(rings - 1, j), ring(rings - 1, j + 1))]
        for k in range(rings - 1):
            faces += [(ring(k, j), ring(k, j + 1), ring(k + 1, j)),
                      (ring(k, j + 1), ring(k + 1, j + 1), ring(k + 1, j))]
    return "\n".join(["OFF", f"{len(points)} {len(faces)} 0",
                      *("{:.9g} {:.9g} {:.9g}".format(*p) for p in points),
                      *("3 {} {} {}".format(*f) for f in faces)]) + "\n"


@pytest.mark.release
def test_tearing_neck(case):
    rows = case.trial("tearing neck", "tearing-neck.prm",
                      {"Tissue/Surface mesh": "{files}/dumbbell.off"},
                      {"dumbbell.off": dumbbell()}, exits=(0, 2)).rows
    case.found("tearing neck: pulled to [µm]", rows["xmax"][-1] - rows["xmin"][-1],
               at_least=600)
