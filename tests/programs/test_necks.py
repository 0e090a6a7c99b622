# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Necks that the grid does not resolve: the run names the narrowest one, with its place and
width; sheets, bars and balls have none."""
import math
import re

import numpy as np
import pytest

from tests.common.bodies import SCENE as BODIES
from tests.common.bodies import annulus, block, points_files, rectangle

SCENE = {**{key: value for key, value in BODIES.items() if key not in (
    "Cell types/Names", "Contact/Bodies", "Contact/Between")},
    "Time/End time": 0.1, "Output/Formats": "none"}
NECK = re.compile(r"a neck about ([-0-9.e]+) um wide, ([0-9.e]+) grid spacings, near \(([-0-9.e ]+)\)")


def two_discs(runs, width):
    """Discs of 40 um that overlap, and their neck."""
    side = math.sqrt(40**2 - width**2 / 4)
    start = math.asin(width / 80)
    arc = [(-side + 40 * math.cos(a), 40 * math.sin(a))
           for a in np.linspace(start, 2 * math.pi - start, 100)]
    ring = [*arc, *((-x, -y) for x, y in arc[1:-1])]
    cells = [(x, y, v) for sign in (-1, 1) for y, x, v, _ in annulus(0, 40, "", sign * side)
             if sign * x > 0]
    return {**SCENE, **points_files(runs, cells, [[[*ring, ring[0]]]]),
            "Tissue/Boundary points": 200}


def dumbbell(runs, width):
    """Two balls of 25 um that a smooth rod of 10 um connects, as a mesh."""
    def radius(x):
        a = abs(x) - 5
        if a < 20:
            return width / 2 + (25 - width / 2) * (1 - math.cos(math.pi * max(a, 0) / 20)) / 2
        return math.sqrt(max(25**2 - (a - 20)**2, 0))
    xs, k = np.linspace(-50, 50, 81), 40
    angles = [2 * math.pi * j / k for j in range(k)]
    points = [(-50, 0, 0), *((x, radius(x) * math.cos(a), radius(x) * math.sin(a))
                             for x in xs[1:-1] for a in angles), (50, 0, 0)]
    last = len(points) - 1
    faces = []
    for j in range(k):
        i = (j + 1) % k
        faces += [(0, 1 + i, 1 + j), (last, last - k + j, last - k + i)]
        for start in range(1, last - k, k):
            faces += [(start + j, start + i, start + k + i), (start + j, start + k + i, start + k + j)]
    text = "".join(["OFF\n", f"{len(points)} {len(faces)} 0\n",
                    *("{:.6f} {:.6f} {:.6f}\n".format(*p) for p in points),
                    *("3 {} {} {}\n".format(*f) for f in faces)])
    return {"Dimension": 3, "Time/End time": 0.1, "Time/Step": 0.1, "Tissue/Shape": "mesh",
            "Tissue/Surface mesh": runs.write("dumbbell.off", text), "Tissue/Cell spacing": 4,
            "Grid/Spacing": 10, "Output/Formats": "none"}


@pytest.mark.parametrize("scene, width, keys, ranks", [
    (two_discs, 10, {}, 1), (two_discs, 15, {"Contact/Between": "all"}, 1), (two_discs, 22, {}, 3),
    (dumbbell, 10, {}, 1), (dumbbell, 22, {}, 2)])
def test_it_is_named(runs, scene, width, keys, ranks):
    run = runs.run("neck", scene(runs, width), keys, ranks=ranks)
    (found, spacings, place), = NECK.findall(run.said)
    assert abs(float(found) - width) <= 3.5
    assert abs(float(spacings) - float(found) / 10) <= 1e-3
    assert np.linalg.norm([float(x) for x in place.split()]) < 10
    remedy = re.search(r"Set Grid/Spacing = ([0-9.]+) for", run.said)
    assert abs(float(remedy[1]) - float(found) / 5.8) <= 1e-3


@pytest.mark.parametrize("scene", [
    lambda runs: two_discs(runs, 36), lambda runs: two_discs(runs, 79),
    lambda runs: {**SCENE, **points_files(
        runs, [cell[:3] for cell in block(0, 28, "")], [[rectangle(0, 28)]])}])
def test_there_is_none(runs, scene):
    assert not NECK.search(runs.run("wide", scene(runs)).said)
