# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue that the grid cuts in every possible way: the grid's offset swept through
one grid cell, and the grid turned against the tissue."""
import math
from dataclasses import dataclass, field

import numpy
import pytest

from tests.common.results import positions
from tests.hard.slab import slab

N = 20  # offsets
FITTING = 4  # offsets of the slab's grid by a cell
X, Y, Z = numpy.eye(3)

# Consistent with a clamp whose edge lies inside grid cells: see doc/hard-cases.md.
GENTLE = {"Boundary conditions/Nitsche form": "unsymmetric",
          "Boundary conditions/Nitsche penalty": "20"}
# Grid cells that are at least half full count as inner.
HALF = {**GENTLE, "Boundary conditions/Nitsche penalty": "10",
        "Grid/Occupation parameter": "0.5"}
FIRST_STEP = {"Grid/Extension": "false", "Time/Smallest step": "0.9"}
SMALL = {"Tissue/Radius": "125", "Tissue/Boundary points": "650", "Time/End time": "1"}
# Turned by a whole number of boundary points, so that the clamp is the same.
ANGLE = 23 * 2 * math.pi / 160
TURNED = {"Boundary conditions/Fixed where":
          f"{-math.sin(ANGLE):.15f}*X + {math.cos(ANGLE):.15f}*Y <= 0"}


@dataclass
class Sweep:
    """The grid moved along a direction, through one cell. Limits wider than the usual
    ones are what is measured, not what is wanted."""

    scene: str
    h: float
    direction: numpy.ndarray
    keys: dict = field(default_factory=dict)
    few: tuple = ()  # offsets of contrib/check
    apex: float = 0.002  # deviation from the mean, relative
    linear: float = 0.3  # of iterations, likewise
    condition: float = 3  # largest by smallest

    def run(self, case, name, **options):
        return {i: case.trial(
            f"{name}-{i:02}", f"cut-{self.scene}.prm",
            {"Grid/Offset": ", ".join(f"{i * self.h / N * d:g}"
                                      for d in self.direction[:3]),
             **self.keys, **({} if case.full or self.scene != "sphere" else SMALL)},
            row=name, **options) for i in (range(N) if case.full else self.few)}


DISC, SLAB, SPHERE = ("disc", 50), ("slab", 20), ("sphere", 50)
SWEEPS = {
    "disc, paper's keys, y": Sweep(*DISC, Y, apex=0.004),
    "disc, y": Sweep(*DISC, Y, GENTLE),
    "disc, diagonal": Sweep(*DISC, X + Y, GENTLE, (0, 8)),
    "slab, paper's keys, diagonal": Sweep(*SLAB, X + Y, linear=1, condition=20),
    "slab, y": Sweep(*SLAB, Y, HALF),
    "slab, diagonal": Sweep(*SLAB, X + Y, HALF, (0, 13)),
    "sphere": Sweep(*SPHERE, X + Y + Z, GENTLE),
    "sphere, paper's keys": Sweep(*SPHERE, X + Y + Z, apex=0.006, linear=0.4)}
PLAIN = {"disc": Sweep(*DISC, X + Y, FIRST_STEP, (8, 13)),
         "slab": Sweep(*SLAB, X + Y, FIRST_STEP)}


def apex(trial, up):
    """Height of the surface's highest point, µm."""
    return (positions(trial.results.last_surface()) @ up).max()


def deviation(values):
    """The largest deviation from the mean, in units of the mean."""
    return max(abs(numpy.array(values) / numpy.mean(values) - 1))


def few(sweeps):
    return [pytest.param(name, marks=[] if sweep.few else pytest.mark.release)
            for name, sweep in sweeps.items()]


@pytest.mark.parametrize("name", few(SWEEPS))
def test_sweep(case, name):
    """With extension, results, iterations and condition vary little."""
    sweep = SWEEPS[name]
    trials = sweep.run(case, name)
    up = Z if sweep.scene == "sphere" else Y
    heights = {i: apex(trial, up) for i, trial in trials.items()}
    case.found(f"{name}: apex, deviation from the mean",
               deviation(list(heights.values())), at_most=sweep.apex)
    for of, most in (("newton", 0.3), ("linear", sweep.linear)):
        case.found(f"{name}: {of} iterations, deviation from the mean",
                   deviation([trial.rows[f"{of}_iterations"].sum()
                              for trial in trials.values()]), at_most=most)
    conditions = [trial.condition() for trial in trials.values()]
    case.found(f"{name}: condition, largest by smallest",
               max(conditions) / min(conditions), at_most=sweep.condition)
    if sweep.scene == "slab":
        height = 60 * slab(1.4)[0]
        off = {i: abs(value / height - 1) for i, value in heights.items()}
        case.found(f"{name}: height against the exact one", max(off.values()),
                   at_most=0.002)
        case.found(f"{name}: likewise, where grid lines pass between cells",
                   max(value for i, value in off.items() if i % FITTING == 0),
                   at_most=1e-6)


@pytest.mark.release
def test_turned(case):
    """Grid and lattice turned against the disc."""
    trial = case.trial("disc-turned", "cut-disc.prm", {**GENTLE, **TURNED}, ranks=(1, 2))
    turned = apex(trial, numpy.array([-math.sin(ANGLE), math.cos(ANGLE), 0]))
    sweep = SWEEPS["disc, y"].run(case, "disc, y, again")
    mean = numpy.mean([apex(trial, Y) for trial in sweep.values()])
    case.found("disc-turned: apex, against the sweep's mean", abs(turned / mean - 1),
               at_most=0.002)


@pytest.mark.parametrize("name", few(PLAIN))
def test_without_extension(case, name):
    """The condition number has no bound, and runs fail."""
    trials = PLAIN[name].run(case, f"{name}, no extension", exits=(0, 2))
    failed = [trial.code == 2 for trial in trials.values()]
    case.found(f"{name}, no extension: share of runs that fail", numpy.mean(failed),
               at_least=0.1)
    case.found(f"{name}, no extension: largest condition",
               max(trial.condition() for trial in trials.values()), at_least=1e9)
