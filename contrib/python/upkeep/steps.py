# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs step programs as their pages say, and writes what these show: the
tables of this version (doc/measured), pictures in doc/images/steps.

    contrib/upkeep/step-pages          all of them, in some four minutes of one core
    contrib/upkeep/step-pages 2 7      those of steps 2 and 7

The runs stand in output/step-N. The programs must have been built.
"""
import re
import shlex
import sys
from pathlib import Path

from morula.execute import call, overrides
from morula.tables import markdown
from upkeep import step_plots as plots
from upkeep.made import made_with
from upkeep.step_tables import tables
from upkeep.version_data import store

from tests.common.results import read_csv

ROOT = Path(__file__).resolve().parents[3]

OUTPUT = ROOT / "output"
PICTURES = ROOT / "doc/images/steps"


def run(number, directory=None, **keys):
    """Runs a step with keys (Section__Key=value), and returns its tables."""
    directory = directory or OUTPUT / f"step-{number}"
    keys = {key.replace("__", "/").replace("_", " "): value
            for key, value in keys.items()}
    text = said([ROOT / f"build/step-{number}", ROOT /
                 f"prm/step-{number}.prm", "--replace",
                 *overrides({"Output directory": directory, **keys})])
    # What the runs inside say of what they apply and of their progress is not
    # for the page, nor what they warn of, which the text of the page speaks of.
    lines = [line for line in text.splitlines()
             if line and not re.match(r"step \d|Finished|  |"
                                      "(Warning|Material|Applied|Piece): ", line)]
    if lines:
        keep(directory.name, "```\n" + "\n".join(lines) + "\n```")
    return tables(text)


def said(words):
    """What a command prints; without success, the tool ends."""
    ended = call(words, cwd=ROOT, stderr=None)
    if ended.code:
        sys.exit(f"step-pages: {shlex.join(map(str, words))} ended with exit "
                 f"code {ended.code}")
    return ended.stdout


def keep(name, table):
    """Stores a table of this version."""
    store("steps", {name: table}, made_with(ROOT), ROOT)


def render(directory, name, *options):
    """A picture of a tissue, by contrib/render."""
    said([ROOT / "contrib/render", directory, *options, "--output",
          PICTURES / name])


def step_1():
    plots.step_1(run(1), PICTURES / "step-1.png")


def step_2():
    errors = run(2)
    cells = read_csv(OUTPUT / "step-2/4/cells-0001.csv")
    plots.step_2(errors, cells, PICTURES / "step-2.png")


def step_3():
    run(3)
    top = OUTPUT / "step-3-top"
    run(3, top, Growth__Isotropic__Stretch="1 + 0.1*t*(Z > 100)")
    render(top, "step-3.png", "--panels", "2", "--field", "energy_density",
           "--width", "600")


def step_4():
    plots.step_4(run(4), PICTURES / "step-4.png")


def step_5():
    run(5)
    render(OUTPUT / "step-5/seed-1", "step-5.png", "--panels", "2", "--field",
           "generation", "--width", "600")


def step_6():
    run(6)
    plots.step_6(read_csv(OUTPUT / "step-6/layers.csv"),
                 PICTURES / "step-6.png")
    render(OUTPUT / "step-6/J-0.9", "step-6-tissue.png", "--panels", "2",
           "--field", "elastic_volume_ratio", "--width", "600",
           "--range", "0.5,1")


def step_7():
    runs = {}
    for law in ("none", "crowding limited"):
        for rule in ("random", "long axis"):
            directory = OUTPUT / f"step-7-{law}-{rule}".replace(" ", "-")
            run(7, directory, Growth__Law=law,
                Proliferation__Cell_cycle__Division_axis=rule)
            runs[f"{law}, {rule}"] = read_csv(directory / "statistics.csv")
    last = [(name, rows[-1]) for name, rows in runs.items()]
    keep("step-7-runs", markdown(
        ["growth law, division rule", "cells", "mean energy, kPa",
         "smallest $J_e$", "largest $J_e$", "largest width, µm"],
        [[name, f"{row['cells']:.0f}", f"{row['mean_energy_density']:.4f}",
          f"{row['min_elastic_volume_ratio']:.3f}",
          f"{row['max_elastic_volume_ratio']:.3f}",
          f"{row['ymax'] - row['ymin']:.1f}"] for name, row in last]))
    run(7)
    plots.step_7(runs, PICTURES / "step-7.png")
    render(OUTPUT / "step-7", "step-7-tissue.png", "--field",
           "elastic_volume_ratio", "--range", "0.7,1.3")


def main():
    if {"-h", "--help"} & set(sys.argv):
        print(__doc__)
        return
    OUTPUT.mkdir(exist_ok=True)
    PICTURES.mkdir(parents=True, exist_ok=True)
    steps = {str(n): globals()[f"step_{n}"] for n in range(1, 8)}
    for number in sys.argv[1:] or steps:
        if number not in steps:
            sys.exit(f"step-pages: there is no step '{number}'; there are 1 "
                     "to 7.")
        steps[number]()
