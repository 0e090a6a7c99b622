# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where the grid lies: offsets through one grid cell, and what else tells the
runs of a point from each other."""
import math
from dataclasses import dataclass

from morula.command_line import whole_number
from morula.refusal import Refused
from morula.scene import as_number
from scipy.stats import qmc

OPTION = "--offsets"
KEY = "Grid/Offset"
MOST = 256


@dataclass(frozen=True)
class Sample:
    """One of the runs of every point: a seed, or None for the scene's, and by
    how much of a grid cell its grid is moved, or None."""

    seed: int = None
    moved: tuple = None

    def overrides(self, keys):
        """(key, value) beside those of the point, which has these keys."""
        found = {}
        if self.moved and any(self.moved):
            found[KEY] = moved_offset(keys, self.moved)
        if self.seed is not None:
            found["Random seed"] = str(self.seed)
        return list(found.items())


def read_offsets(text, plan):
    """The --offsets option: a number of offsets, or None without it."""
    if text is None:
        return None
    number = whole_number(OPTION, text)
    if not 2 <= number <= MOST:
        raise Refused(OPTION, text, f"an integer from 2 to {MOST}")
    if KEY in plan.keys:
        raise Refused("--vary", KEY, f"another key with {OPTION}",
                      "That option moves the grid already.")
    return number


def samples(seeds, n_offsets, dimension):
    """All runs of a point: every seed at every offset."""
    moved = fractions(n_offsets, dimension) if n_offsets else [None]
    return [Sample(seed, where) for where in moved for seed in seeds or [None]]


def fractions(number, dimension):
    """The first points of Sobol's sequence: of 2^k points each direction has the
    positions i/2^k once; a larger number has the points of every smaller one."""
    points = qmc.Sobol(dimension, scramble=False).random_base2(max(1, math.ceil(math.log2(number))))
    return [tuple(map(float, point)) for point in points[:number]]


def moved_offset(keys, moved):
    """Grid/Offset, moved by these parts of the spacing."""
    own = [as_number(word) or 0.0 for word in keys[KEY].split(",")]
    own += [0.0] * (len(moved) - len(own))
    spacing = float(keys["Grid/Spacing"])
    return ",".join(format(there + part * spacing, ".15g") for there, part in zip(own, moved))
