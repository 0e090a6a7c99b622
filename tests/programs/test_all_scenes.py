# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Every scene of prm/: the warnings that it deserves at full size, and, of those that no
other test runs, one step on a coarser lattice and grid, so that no scene rots."""
import math
import re
from pathlib import Path

import numpy
import pytest
from morula.execute import overrides
from morula.prm import parse

from tests.common.results import read_csv
from tests.hard import test_small_and_thin

ROOT = Path(__file__).resolve().parents[2]
MOST_CELLS = 1000

# Files of scenes that their hard cases write.
MADE = {"hard/close-bodies.prm": ("Tissue/Points file", "cells.csv",
                                  test_small_and_thin.two_blocks(60)),
        "hard/tearing-neck.prm": ("Tissue/Surface mesh", "dumbbell.off",
                                  test_small_and_thin.dumbbell())}

# Few cells per grid spacing, or tissue thinner than a grid cell: these scenes are there
# to show how far that goes.
WARNED = {f"hard/{name}.prm": ["Grid/Spacing"] for name in (
    "breaking-off", "from-27-cells", "small-and-thin", "thin-strip", "twelve-generations")}
WARNED["showcase/cortex.prm"] = ["Grid/Spacing"]
# Whole cells do not fit their shapes to some percent.
WARNED["hard/mesh.prm"] = WARNED["hard/solver.prm"] = ["Tissue/Cell spacing"]
# It is pushed and nothing holds it: that is what it is about.
WARNED["hard/pushed-body.prm"] = ["Boundary conditions"]

# Only its own program knows its growth law: tests/steps runs it.
# These take a second or more to seed; none of them deserves another warning.
LARGE = ("showcase/cortex.prm", "verification/vortex-3d.prm", "paper/fig-2e.prm")

SCENES = sorted({str(file.relative_to(ROOT / "prm"))
                 for file in (ROOT / "prm").rglob("*.prm")} - {"step-7.prm"})


def run_elsewhere():
    """Names of scenes that tests of contrib/check run."""
    texts = [file.read_text() for folder in ("programs", "hard", "verification")
             for file in (ROOT / "tests" / folder).glob("test_*.py")
             if file != Path(__file__)]
    return {name for name in SCENES for text in texts
            if re.search(rf'["/]{re.escape(Path(name).name)}"', text)}


def volume(keys, dim):
    """Of the shape, um^dim; 0 for shapes from files."""
    numbers = [float(x) for x in keys.get("Tissue/Size", "200, 200, 200").split(",")]
    product = math.prod(numbers[:dim])
    radius = float(keys.get("Tissue/Radius", 250))
    ball = {2: math.pi * radius**2, 3: 4 / 3 * math.pi * radius**3}[dim]
    return {"sphere": ball, "box": product,
            "ellipsoid": product * math.pi / (4 if dim == 2 else 6),
            "cylinder": math.pi * radius**2 * numbers[-1]
            }.get(keys.get("Tissue/Shape", "sphere"), 0)


def shortened(keys):
    """Overrides for one step of a few cells; h / L_p stays."""
    dim = int(keys.get("Dimension", 3))
    spacing = float(keys.get("Tissue/Cell spacing", 10))
    n = volume(keys, dim) / spacing**dim
    factor = max(1.0, (n / MOST_CELLS)**(1 / dim))
    size = "Division by size/Volume"
    larger = ({size: f"{factor**dim * float(keys[size]):.10g}"}
              if keys.get(size, "").replace(".", "").isdigit() else {})
    return {**larger, "Time/End time": keys.get("Time/Step", "0.05"),
            "Output/Interval": "0", "Output/Snapshot interval": "0",
            "Tissue/Cell spacing": f"{factor * spacing:.10g}",
            "Grid/Spacing": f"{factor * float(keys.get('Grid/Spacing', 50)):.10g}"}


def call(runs, name, keys, *words):
    """The program in the root, as users call it, with the files that it needs."""
    if name in MADE:
        key, file, text = MADE[name]
        keys = {**keys, key: runs.write(file, text)}
    return runs.call(runs.command(ROOT / "prm" / name, *words, *overrides(keys)),
                     cwd=ROOT)


@pytest.mark.parametrize("name", sorted(set(SCENES) - run_elsewhere()))
def test_one_step(runs, name):
    folder = (ROOT / "prm" / name).parent
    keys = shortened(parse((ROOT / "prm" / name).read_text(), folder))
    output = runs.work / name
    call(runs, name, {**keys, "Output directory": output})
    rows = read_csv(output / "statistics.csv")
    assert rows["time"][-1] == float(keys["Time/End time"])
    assert rows["unknowns"][0] > 0
    assert all(numpy.isfinite(rows[column][-1]) for column in rows.dtype.names)


@pytest.mark.parametrize("name", [
    pytest.param(name, marks=pytest.mark.release) if name in LARGE else name
    for name in SCENES])
def test_warnings(runs, name):
    """At full size, none but those that are deserved."""
    text = call(runs, name, {}, "--explain").stdout
    assert re.findall(r"^Warning: (.*?) = ", text, re.M) == WARNED.get(name, [])
