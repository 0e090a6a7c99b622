# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth that ends in buckling, wrinkling and creasing."""
import numpy

from tests.common.results import read_csv
from tests.hard import clamped_rod
from tests.cases.case import Case, Finding, Limit, Trial
from tests.hard.stability import Part, half_space, layers, rings

ROD = 2 * numpy.pi / 400  # wave number of the modes of both rods, 1/µm
COARSE_ROD = {"Tissue/Cell spacing": "5", "Grid/Spacing": "20"}
NO_FORCE = {"Body force/Force density": "0; 0; 0"}

FILM = Limit("The critical strain of a buckling rod and of a stiff film on a "
             "soft base agrees with theory to {tolerance:g} of it.",
             equals=(1, 0.03))
RING = Limit("That of a stiff ring around a core agrees to {tolerance:g}.",
             equals=(1, 0.05))
BEYOND = Limit("Beyond it the square of a rod's deflection rises with growth "
               "as theory says, to {tolerance:g} of the slope.",
               equals=(1, 0.15))
FLAT = Limit("Before creases are possible, waves of the compressed layer are "
             "less than {at_most:g} µm deep.", at_most=0.5)


def theta(results, t):
    """The largest growth at a time."""
    text = results.keys["Growth/Isotropic/Stretch"]
    inside = {"X": 0.0, "Y": 0.0, "t": t}
    for X, Y in ((0.0, 10.0), (190.0, 0.0)):  # in the film, in the ring
        inside.update(X=X, Y=Y)
        value = eval(text.replace("^", "**"), {}, inside)
        if value > 1:
            return value
    return 1.0


def amplitudes(results, kind, shapes, value):
    """Growths and amplitudes of the first of the shapes, functions of the cells
    or boundary points, in a least-squares fit to a value of theirs."""
    growths, found = [], []
    for file in results.outputs(kind):
        points = read_csv(file)
        matrix = numpy.stack(shapes(points), axis=-1)
        keep = ~numpy.isnan(matrix[:, 0])
        found.append(numpy.linalg.lstsq(matrix[keep], value(points)[keep],
                                        rcond=None)[0])
        growths.append(theta(results, points["time"][0]))
    return numpy.array(growths), numpy.array(found)


def critical(growths, w, smallest, largest):
    """The growth at which the perfect body would buckle, from the amplitudes w of
    the imperfect one: theta = theta_c + a w^2 + b w^4 - c/w."""
    w = numpy.abs(w)
    here = (w > smallest) & (w < largest)
    matrix = numpy.stack([w[here]**0, w[here]**2, w[here]**4, -1 / w[here]],
                         axis=-1)
    if here.sum() < 5:
        return numpy.nan
    return numpy.linalg.lstsq(matrix, growths[here], rcond=None)[0][0]


def lift(points):
    return points["y"] - points["Y"]


def strain(name, growth, right, limit):
    """The finding about a critical growth strain theta_c - 1."""
    return limit.found(f"{name}: critical strain over theory's {right - 1:.5f}",
                       (growth - 1) / (right - 1), error=True, trial=name)


def judge_rods(runs):
    exact = layers([Part(0, 40, theta=lambda t: t)]).critical(
        ROD, 1.001, 1.1, samples=20)
    fitted = clamped_rod.critical(length=400, thickness=40)
    yield Finding("clamped rod, critical growth: elements against Euler",
                  fitted - (1 + (ROD * 40)**2 / 12), equals=(0, 1e-3))
    for name, right, shape in (("rod", exact, numpy.sin),
                               ("clamped-rod", fitted, numpy.cos)):
        growths, found = amplitudes(
            runs[name].results, "cells",
            lambda points: [shape(ROD * points["X"]), 1 + 0 * points["X"]], lift)
        yield strain(name, critical(growths, found[:, 0], 1e-3, 15), right,
                     FILM)
        slope = numpy.polyfit(found[-5:, 0]**2, growths[-5:], 1)[0]
        # an inextensible rod: (k w)^2/4 of its length is hidden in the wave
        yield BEYOND.found(f"{name}: d theta/d w^2 over k^2/4",
                           slope / (ROD**2 / 4))
    for name, least, most in (("rod-perfect", 15, None),
                              ("rod-perfect-direct", None, 1e-3)):
        found = amplitudes(runs[name].results, "cells",
                           lambda points: [numpy.sin(ROD * points["X"])], lift)[1]
        yield Finding(f"{name}: deflection [µm]", abs(found[-1, 0]),
                      at_least=least, at_most=most, error=True, trial=name)


def judge_film(runs):
    results = runs["film"].results
    waves = layers([Part(-200, 0), Part(0, 20, E=30, theta=lambda t: t)],
                   held_begin=("normal", "tangential"))
    right = {n: waves.critical(n * numpy.pi / 400, 1.03, 1.13, samples=10)
             for n in range(2, 6)}

    def shapes(points):
        top = numpy.where(points["Y"] > 19.9, 1.0, numpy.nan)
        return [top * numpy.cos(n * numpy.pi / 400 * (points["X"] + 200))
                for n in range(9)]

    growths, found = amplitudes(results, "surface", shapes, lift)
    wave = 1 + numpy.argmax(numpy.abs(found[-1, 1:]))
    yield Finding("film: half-waves", wave,
                  equals=(min(right, key=right.get), 0))
    yield strain("film", critical(growths, found[:, 3], 1e-3, 15), right[3],
                 FILM)


def judge_ring(runs):
    results = runs["ring"].results
    waves = rings([Part(0, 180), Part(180, 200, E=10, theta=lambda t: t)],
                  elements_per_part=3)
    right = {n: waves.critical(n, 1.15, 1.4, samples=8) for n in range(4, 8)}

    def shapes(points):
        angle = numpy.arctan2(points["Y"], points["X"])
        return [1 + 0 * angle] + [wave(n * angle) for n in range(1, 11)
                                  for wave in (numpy.cos, numpy.sin)]

    growths, found = amplitudes(
        results, "surface", shapes, lambda points: numpy.hypot(points["x"],
                                                               points["y"]))
    found = numpy.hypot(found[:, 1::2], found[:, 2::2])
    wave = 1 + numpy.argmax(found[-1])
    yield Finding("ring: waves around", wave, equals=(min(right, key=right.get), 0))
    yield strain("ring", critical(growths, found[:, 5], 0.02, 15), right[6],
                 RING)


def judge_layer(runs):
    """Flat before creases can exist, creased before Biot's instability."""
    results = runs["layer"].results
    depth = []
    for file in results.outputs("surface"):
        points = read_csv(file)
        top = points["y"][points["Y"] > 79.9]
        depth.append([theta(results, points["time"][0]), top.max() - top.min()])
    depth = numpy.array(depth)
    creased = depth[depth[:, 1] > 20, 0]
    first = creased[0] if len(creased) else numpy.inf
    yield Finding("layer: growth at which it has creased", first,
                  at_most=half_space(nu=0.4), error=True, trial="layer")
    # 1/0.647: creases of incompressible half-spaces (Hong, Zhao & Suo 2009)
    yield FLAT.found("layer: depth of its waves at theta = 1.54 [µm]",
                     depth[depth[:, 0] <= 1.5401, 1].max())


def judge(runs):
    for part in (judge_rods, judge_film, judge_ring, judge_layer):
        yield from part(runs)


CASE = Case(
    title="Growth that ends in a fold",
    judge=judge, limits=(FILM, RING, BEYOND, FLAT),
    trials=[
        Trial("rod", "growing-rod.prm", quick=COARSE_ROD, timeout=300),
        Trial("rod-perfect", "growing-rod.prm", keys=NO_FORCE, quick=COARSE_ROD,
              timeout=300),
        Trial("rod-perfect-direct", "growing-rod.prm", quick=COARSE_ROD,
              keys={**NO_FORCE, "Solver/Linear solver": "direct"}, timeout=300),
        Trial("clamped-rod", "clamped-rod.prm", quick=COARSE_ROD, timeout=300),
        Trial("film", "wrinkling-film.prm", quick={"Tissue/Cell spacing": "5"},
              timeout=600),
        Trial("ring", "growing-ring.prm", quick={"Tissue/Cell spacing": "4"},
              timeout=600),
        Trial("layer", "growing-layer.prm",
              quick={"Growth/Isotropic/Stretch": "1.5 + 0.4*t",
                     "Time/Step": "0.05", "Time/End time": "1",
                     "Output/Interval": "0.05"},
              timeout=600),
    ])
