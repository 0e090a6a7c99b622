# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue smaller than what the grid resolves: clusters, rods, sheets, necks."""
import numpy

from tests.common.results import initial_positions, positions
from tests.cases.case import Case, Finding, Limit, Trial

SHAPES = {"1 cell": "10, 10, 10", "2 cells": "20, 10, 10",
          "8 cells": "20, 20, 20", "27 cells": "30, 30, 30",
          "rod of 1 x 1 cells": "200, 10, 10",
          "rod of 2 x 2 cells": "200, 20, 20",
          "sheet of 1 cell": "200, 200, 10",
          "sheet of 2 cells": "200, 200, 20",
          "sheet of 4 cells": "200, 200, 40"}
OFFSETS = {"on a line": "0, 0, 0", "anyhow": "3, 14, 22",
           "between": "25, 25, 25"}
STRIP_OFFSETS = ("0, 0", "10, 20", "7, 13", "0, 31")

EXACT = Limit("Small and thin pieces that grow evenly by half keep their "
              "exact shape to {at_most:g} µm, wherever the grid's lines lie.",
              at_most=1e-5)
ARC = Limit("The strip that bends is off its exact arc by at most "
            "{at_most:g} µm.", at_most=0.3)
APART = Limit("A body moves by less than {at_most:g} µm when another one "
              "grows behind an empty layer of grid cells.", at_most=1e-9)
STUCK = Limit("Bodies in touching grid cells pull each other: the other one "
              "moves by more than {at_least:g} µm.", at_least=0.1)


def free_growth(points, theta, centre):
    """Largest distance (µm) from the exact positions."""
    exact = centre + theta * (initial_positions(points) - centre)
    return numpy.abs(positions(points) - exact).max()


def judge_pieces(runs):
    for shape in SHAPES:
        cells, surface = [], []
        for place in OFFSETS:
            results = runs[f"{shape}, {place}"].results
            last = results.last_cells()
            centre = initial_positions(last).mean(axis=0)
            cells.append(free_growth(last, 1.5, centre))
            surface.append(free_growth(results.last_surface(), 1.5, centre))
        # Nothing holds a row of single cells against turning about its line.
        row = shape == "rod of 1 x 1 cells"
        yield EXACT.found(f"{shape}: cells are off by [µm]", max(cells),
                          error=True, trial=shape)
        yield Finding(f"{shape}: the surface is off by [µm]", max(surface),
                      at_most=1e-4 if row else 1e-5, error=True, trial=shape)


def arc(X, a):
    """Where exp(a Y) takes a straight strip: w = i/a exp(-i a z)."""
    w = 1j / a * (numpy.exp(-1j * a * (X[:, 0] + 1j * X[:, 1])) - 1)
    return numpy.stack([w.real, w.imag], axis=1)


def aligned(x, y):
    """x moved rigidly as near to y as possible."""
    x, y = x - x.mean(axis=0), y - y.mean(axis=0)
    U, _, V = numpy.linalg.svd(x.T @ y)
    turn = U @ numpy.diag([1, numpy.linalg.det(U @ V)]) @ V
    return x @ turn, y


def judge_strips(runs):
    errors = []
    for offset in STRIP_OFFSETS:
        cells = runs[f"strip {offset}"].results.last_cells()
        x, exact = aligned(positions(cells)[:, :2],
                           arc(initial_positions(cells)[:, :2], 0.004))
        errors.append(numpy.linalg.norm(x - exact, axis=1).max())
    yield ARC.found("the strip is off the arc by [µm]", max(errors),
                    error=True, trial="thin strip that bends")


def block(first, last):
    """Centres of cells of 10 µm that fill a box."""
    axes = [numpy.arange(a + 5, b, 10.0) for a, b in zip(first, last)]
    return numpy.stack(numpy.meshgrid(*axes), axis=-1).reshape(-1, len(axes))


def points_file(*blocks):
    X = numpy.concatenate(blocks)
    header = ",".join("xyz"[:X.shape[1]])
    return header + "\n" + "\n".join(
        ",".join(f"{value:g}" for value in row) for row in X) + "\n"


def two_blocks(gap):
    return lambda: points_file(block((-150, 0), (0, 150)),
                               block((gap, 0), (gap + 150, 150)))


def chain():
    """Two blocks joined by a chain of single cells."""
    return points_file(block((-150, -50), (-50, 50)),
                       block((-50, 0), (50, 10)),
                       block((50, -50), (150, 50)))


def judge_bodies(runs):
    for name in ("60", "110"):
        cells = runs[f"gap of {name}"].results.last_cells()
        left = cells["X"] < 0
        centre = initial_positions(cells)[left].mean(axis=0)
        yield Finding(f"gap of {name} µm: the growing body is off by [µm]",
                      free_growth(cells[left], 1.1, centre), at_most=1e-5,
                      error=True, trial="two bodies")
        yield APART.found(f"gap of {name} µm: the other one moves by [µm]",
                          free_growth(cells[~left], 1.0, centre))
    cells = runs["gap of 20"].results.last_cells()
    left = cells["X"] < 0
    yield STUCK.found("gap of 20 µm: the other one is pulled along by [µm]",
                      free_growth(cells[~left], 1.0, 0), error=True,
                      trial="two bodies in touching grid cells")
    cells = runs["chain"].results.last_cells()
    head = cells["X"] < -80
    centre = initial_positions(cells)[head].mean(axis=0)
    yield Finding("block on a chain: growth ratio",
                  (cells["volume"][head] / cells["initial_volume"][head]).mean(),
                  equals=(1.21, 0.01), error=True, trial="chain")


def dumbbell(n=24):
    """A closed surface of revolution about x, as OFF text."""
    x = numpy.concatenate([-60 - 60 * numpy.cos(numpy.linspace(0, 2.6, 14)),
                           60 + 60 * numpy.cos(numpy.linspace(2.6, 0, 14))])
    r = numpy.concatenate([60 * numpy.sin(numpy.linspace(0, 2.6, 14)),
                           60 * numpy.sin(numpy.linspace(2.6, 0, 14))])
    r = numpy.maximum(r, 8)
    phi = 2 * numpy.pi * numpy.arange(n) / n
    rings = [[(xi, ri * numpy.cos(p), ri * numpy.sin(p)) for p in phi]
             for xi, ri in zip(x[1:-1], r[1:-1])]
    points = [(x[0], 0, 0), *sum(rings, []), (x[-1], 0, 0)]
    ring = lambda k, j: 1 + k * n + j % n
    faces = [(0, ring(0, j + 1), ring(0, j)) for j in range(n)]
    for k in range(len(rings) - 1):
        for j in range(n):
            faces += [(ring(k, j), ring(k, j + 1), ring(k + 1, j)),
                      (ring(k, j + 1), ring(k + 1, j + 1), ring(k + 1, j))]
    last, k = len(points) - 1, len(rings) - 1
    faces += [(last, ring(k, j), ring(k, j + 1)) for j in range(n)]
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += ["{:.9g} {:.9g} {:.9g}".format(*p) for p in points]
    lines += ["3 {} {} {}".format(*f) for f in faces]
    return "\n".join(lines) + "\n"


def judge_neck(runs):
    run = runs["tearing neck"]
    statistics = run.results.statistics()
    yield Finding("tearing neck: pulled to [µm]",
                  statistics["xmax"][-1] - statistics["xmin"][-1],
                  at_least=600, error=True,
                  trial="tearing neck")


def judge(runs):
    for part in (judge_pieces, judge_strips, judge_bodies, judge_neck):
        yield from part(runs)


def bodies(name, file, row="two bodies", offset="0, 0"):
    return Trial(name, "close-bodies.prm", row=row, ranks=(1, 2),
                 files={"cells.csv": file},
                 keys={"Tissue/Points file": "{files}/cells.csv",
                       "Grid/Offset": offset})


CASE = Case(
    title="Tissue smaller or thinner than a grid cell, and bodies close by",
    judge=judge, limits=(EXACT, ARC, APART, STUCK),
    trials=[Trial(f"{shape}, {place}", "small-and-thin.prm", row=shape,
                  keys={"Tissue/Size": size, "Grid/Offset": offset})
            for shape, size in SHAPES.items()
            for place, offset in OFFSETS.items()]
    + [Trial(f"strip {offset}", "thin-strip.prm", row="thin strip that bends",
             keys={"Grid/Offset": offset}) for offset in STRIP_OFFSETS]
    # At 60, the grid's lines leave one layer of grid cells empty.
    + [bodies("gap of 60", two_blocks(60), offset="10, 0"),
       bodies("gap of 110", two_blocks(110)),
       bodies("gap of 20", two_blocks(20), row="two bodies in touching grid "
              "cells")]
    + [bodies("chain", chain, row="chain")]
    + [Trial("tearing neck", "tearing-neck.prm", exit=(0, 2),
             files={"dumbbell.off": dumbbell},
             message="the step failed even at",
             keys={"Tissue/Surface mesh": "{files}/dumbbell.off"},
             quick={"Time/Step": "0.1"})])
