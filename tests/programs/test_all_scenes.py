# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Every scene of prm/ that no case runs does: one step, on a coarser lattice and grid
where it has many cells, so that no scene rots. The figures they are for are judged
elsewhere."""
import math
from pathlib import Path

from morula.prm import parse
from tests.common.program import ProgramTest, overrides, read_csv

from tests.cases.tool import all_names, case_of
from tests.hard.cases import small_and_thin

ROOT = Path(__file__).resolve().parents[2]

MOST_CELLS = 1000

# Files of scenes that their hard cases write.
MADE = {"hard/close-bodies.prm": ("Tissue/Points file", "cells.csv",
                                  small_and_thin.two_blocks(60)),
        "hard/tearing-neck.prm": ("Tissue/Surface mesh", "dumbbell.off",
                                  small_and_thin.dumbbell)}

# Few cells per grid spacing, or tissue thinner than a grid cell: these scenes
# are there to show how far that goes.
WARNED = {f"hard/{name}.prm": ["Grid/Spacing"] for name in (
    "breaking-off", "division", "enclosed-sphere", "from-27-cells",
    "small-and-thin", "solver", "thin-strip", "twelve-generations")}
WARNED["step-6.prm"] = ["Grid/Spacing"]
# The growing layer is to be many grid cells thick, in seconds.
WARNED["examples/folding-by-tangential-growth.prm"] = ["Grid/Spacing"]
# Its layer has two grid spacings, and these two cells each, for time and memory.
WARNED["showcase/cortex.prm"] = ["Grid/Spacing"]
# Their tension is to smooth the outline, be it somewhat late.
WARNED["showcase/spheroid.prm"] = ["Time/Step"]
WARNED["examples/turnover.prm"] = ["Time/Step"]

# Its states follow its days, not its steps.
WARNED["showcase/organoid.prm"] = ["Output/Interval"]

# Whole cells do not fit their shapes to some percent.
WARNED["hard/mesh.prm"] = ["Tissue/Cell spacing"]
WARNED["hard/solver.prm"] = ["Tissue/Cell spacing", "Grid/Spacing"]

# Its bodies are near each other: that is what it is about.
WARNED["hard/close-bodies.prm"] = ["Grid/Spacing"]

# It is pushed and nothing holds it: that is what it is about.
WARNED["hard/pushed-body.prm"] = ["Boundary conditions"]

# Only its own program knows its growth law: tests/steps runs it.
OTHERS = {"step-7.prm"}


def volume(keys, dim):
    """Of the shape, um^dim; 0 for shapes from files."""
    numbers = [float(x) for x in
               keys.get("Tissue/Size", "200, 200, 200").split(",")]
    product = math.prod(numbers[:dim])
    radius = float(keys.get("Tissue/Radius", 250))
    ball = {2: math.pi * radius**2, 3: 4 / 3 * math.pi * radius**3}[dim]
    return {"sphere": ball, "box": product,
            "ellipsoid": product * math.pi / (4 if dim == 2 else 6),
            "cylinder": math.pi * radius**2 * numbers[-1]
            }.get(keys.get("Tissue/Shape", "sphere"), 0)


def shortened(scene):
    """Overrides for one step of a few cells; h / L_p stays."""
    keys = parse(scene.read_text(), scene.parent)
    dim = int(keys.get("Dimension", 3))
    step = keys.get("Time/Step", "0.05")
    spacing = float(keys.get("Tissue/Cell spacing", 10))
    n = volume(keys, dim) / spacing**dim
    factor = max(1.0, (n / MOST_CELLS)**(1 / dim))
    size = "Division by size/Volume"
    larger = ({size: f"{factor**dim * float(keys[size]):.10g}"}
              if keys.get(size, "").replace(".", "").isdigit() else {})
    return {**larger,
            "Time/End time": step, "Output/Interval": "0",
            "Output/Snapshot interval": "0",
            "Tissue/Cell spacing": f"{factor * spacing:.10g}",
            "Grid/Spacing":
            f"{factor * float(keys.get('Grid/Spacing', 50)):.10g}"}


def scenes():
    """(file, its name below prm/)"""
    found = [(file, str(file.relative_to(ROOT / "prm")))
             for file in sorted((ROOT / "prm").rglob("*.prm"))]
    return [(file, name) for file, name in found if name not in OTHERS]


def run_by_cases():
    """Names of the scenes that cases run whenever ctest does."""
    return {f"{case.partition('/')[0]}/{trial.scene}" for case in all_names()
            for trial in case_of(case).trials if not trial.full_only}


class AllScenes(ProgramTest):
    def made(self, name):
        """The key of a file that the scene needs, with the file written."""
        if name not in MADE:
            return {}
        key, file, text = MADE[name]
        return {key: str(self.write(file, text()))}

    def test_every_scene_runs(self):
        elsewhere = run_by_cases()
        self.assertGreater(len(scenes()), 50)
        for scene, name in scenes():
            if name in elsewhere:
                continue
            with self.subTest(name):
                keys = {**shortened(scene), **self.made(name)}
                output = self.work / "output"
                self.run_words(self.command(
                    scene, "--replace",
                    *overrides({**keys, "Output directory": output})),
                    cwd=ROOT)
                rows = read_csv(output / "statistics.csv")
                self.assertEqual(rows["time"][-1], float(keys["Time/End time"]))
                self.assertGreater(rows["unknowns"][0], 0)
                for column in rows.dtype.names:
                    self.assertTrue(math.isfinite(rows[column][-1]), column)

    def test_warnings(self):
        """At full size, none but those that are deserved."""
        for scene, name in scenes():
            with self.subTest(name):
                text = self.run_words(
                    self.command(scene, "--explain",
                                 *overrides(self.made(name))), cwd=ROOT).stdout
                found = [line.split(" = ")[0][len("Warning: "):]
                         for line in text.splitlines()
                         if line.startswith("Warning: ")]
                self.assertEqual(found, WARNED.get(name, []))

