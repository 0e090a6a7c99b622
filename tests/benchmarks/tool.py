# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measures what runs cost, and prints one table in Markdown: about five minutes.

    contrib/upkeep/benchmark

Nothing else should run on the machine meanwhile. What the kernels cost next to a
matrix product says build/tests/benchmark_kernels (Google Benchmark).
"""
import argparse
import json
import math
import shutil
import subprocess
from pathlib import Path

from morula.execute import call, command, overrides
from morula.run import Run
from morula.tables import markdown

ROOT = Path(__file__).resolve().parents[2]
HALF_FIXED, PROLIFERATING = "prm/paper/fig-2b.prm", "prm/paper/fig-4b.prm"
# Sections of timings.csv; what happens once, whatever the number of steps, counts
# for no step.
PARTS = {"assembly": ("tangent", "residual"),
         "linear system": ("sparsity pattern", "preconditioner", "linear solver"),
         "grid": ("grid",), "moving the cells": ("commit",)}
BESIDE_STEPS = ("seeding", "output", "rows", "snapshot")


def sphere(n_cells):
    """Fig. 4b with another number of cells, at the same cells per grid cell."""
    radius = 10 * (3 * n_cells / (4 * math.pi))**(1 / 3)
    return {"Tissue/Radius": f"{radius:.6g}",
            "Tissue/Boundary points": round(2600 * (radius / 250)**2),
            "Time/Step": 0.1, "Time/End time": 0.5}


RUNS = [("even growth, Fig. 2b", HALF_FIXED, {}, 1),
        ("— plain kernel", HALF_FIXED, {"Solver/Kernel": "plain"}, 1),
        ("— h = 35 µm", HALF_FIXED, {"Grid/Spacing": 35}, 1),
        ("— h = 70 µm", HALF_FIXED, {"Grid/Spacing": 70}, 1),
        ("growth and division, Fig. 4b", PROLIFERATING, sphere(8000), 1),
        ("— more cells", PROLIFERATING, sphere(65000), 1),
        ("— more cells", PROLIFERATING, sphere(200000), 1),
        ("— on two ranks", PROLIFERATING, sphere(200000), 2)]


def run(output, scene, keys, ranks):
    """The run, and the memory of its largest process, bytes."""
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    ended = call(command(ROOT / "build/morula", ROOT / scene,
                         *overrides({"Output/Interval": 0, "Output/Snapshot interval": 0,
                                     **keys, "Output directory": output / "run"}),
                         ranks=ranks),
                 cwd=ROOT, stdout=output / "log", stderr=subprocess.STDOUT,
                 cost=output / "cost")
    if ended.code != 0:
        raise RuntimeError(f"{scene} ended with {ended.code}: see {output / 'log'}")
    return (Run(output / "run"),
            json.loads((output / "cost").read_text(encoding="utf-8"))["peak_bytes"])


def row(name, scene, keys, ranks, output):
    found, memory = run(output, scene, keys, ranks)
    steps = found.statistics.iloc[1:]
    seconds = found.timings["wall_seconds"]

    def time(sections):
        return seconds.reindex(sections).sum()
    whole = seconds["total"] - time(BESIDE_STEPS)
    newton = steps["newton_iterations"].sum()
    return [name, f"{steps['cells'].iloc[-1]:,.0f}", f"{steps['unknowns'].iloc[-1]:,.0f}",
            f"{1e6 * whole / steps['cells'].sum():.1f}", f"{newton / len(steps):.1f}",
            f"{steps['linear_iterations'].sum() / newton:.0f}",
            *(f"{100 * time(sections) / whole:.0f} %" for sections in PARTS.values()),
            f"{memory / 1e9:.2f}" if ranks == 1 else ""]


def main():
    argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawTextHelpFormatter).parse_args()
    subprocess.run([ROOT / "contrib/build", "morula"], check=True,
                   stdout=subprocess.DEVNULL)
    rows = [row(*each, ROOT / "output/benchmark") for each in RUNS]
    print(markdown(["run", "cells", "unknowns", "µs a cell and step",
                    "Newton iterations a step", "linear ones of each", *PARTS,
                    "memory, GB"], rows, right=10))
    return 0
