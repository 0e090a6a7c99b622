# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Does the measurements of doc/accuracy-and-cost.md, with contrib/accuracy.

    contrib/upkeep/accuracy-ladders                    all three scenes
    contrib/upkeep/accuracy-ladders graded-sphere      this one
    contrib/upkeep/accuracy-ladders --document         and writes the tables of
                                                this version and figures
    contrib/upkeep/accuracy-ladders --short            few and coarse runs, for a test
    contrib/upkeep/accuracy-ladders --list             the commands

Under an hour on two cores with nothing else to do; runs that are there already
are not repeated, and one that was stopped goes on.
"""
import argparse
import re
import shlex
import shutil
from dataclasses import dataclass
from pathlib import Path

from morula.accuracy.tool import main as accuracy
from morula.refusal import Refused

from . import graded_sphere
from .made import made_with
from .version_data import store

ROOT = Path(__file__).resolve().parents[3]
IMAGES = ROOT / "doc/images/accuracy"

NEWTON = "Solver/Newton tolerance=1e-2,1e-4,1e-6,1e-8,1e-10"
LINEAR = "Solver/Linear tolerance=0,1e-1,1e-2,1e-4,1e-8"
OCCUPATION = "Grid/Occupation parameter=0.2,0.5,0.7,0.85,1"


@dataclass(frozen=True)
class DocumentedScene:
    """A scene, its ladders and options, and the figures that are shown."""

    file: str
    ladders: tuple
    options: tuple
    figures: tuple
    short_ladders: tuple
    short_options: tuple


HALF_FIXED = DocumentedScene(
    "prm/paper/fig-2b.prm",
    ("Grid/Spacing=100,75,50,33,25",
     "Tissue/Cell spacing=20,14,10,7,5",
     "Time/Step=2,1,0.5,0.25", NEWTON, LINEAR, OCCUPATION,
     "Grid/Spacing,Tissue/Cell spacing=100:20,75:15,50:10,35:7,25:5"),
    ("--at", "2", "--repeat", "2",
     "--measure", "zmax,total_volume,mean_energy_density",
     "--wanted", "zmax=0.5um,total_volume=1%,mean_energy_density=5%"),
    ("accuracy",),
    ("Grid/Spacing=100,75", "Time/Step=2,1"),
    ("--at", "2", "--measure", "zmax,total_volume,mean_energy_density",
     "-s", "Tissue/Cell spacing=20", "-s", "Grid/Spacing=100"))

FORM = "Boundary conditions/Nitsche form,Boundary conditions/Nitsche penalty"
OPTIONS = DocumentedScene(
    HALF_FIXED.file,
    ("Grid/Spacing=100,75,50,33,25",
     f"unsymmetric and trimmed: Grid/Spacing,{FORM},Tissue/Surface cells="
     + ",".join(f"{h}:unsymmetric:20:trimmed" for h in (100, 75, 50, 33, 25)),
     f"form and penalty: {FORM}=symmetric:1000,unsymmetric:40,"
     "unsymmetric:20,unsymmetric:10",
     "Grid/Points per cell=1,2"),
    ("--at", "4", *HALF_FIXED.options[2:]),
    ("accuracy",),
    ("Grid/Spacing=100,75",
     f"unsymmetric: Grid/Spacing,{FORM}=100:unsymmetric:20,"
     "75:unsymmetric:20"),
    HALF_FIXED.short_options)

REFINED = ("Tissue/Cell spacing,Tissue/Surface cells,Tissue/Boundary points,"
           "Time/Step,Solver/Newton tolerance")
BUDGET = DocumentedScene(
    HALF_FIXED.file,
    ("cells: Tissue/Cell spacing,Tissue/Surface cells=10:whole,10:trimmed,"
     "5:trimmed",
     "Tissue/Boundary points=2600,10400,41600",
     "Time/Step=1,0.5,0.25",
     "Solver/Newton tolerance=1e-6,1e-10", "Solver/Linear tolerance=0,1e-8",
     f"form and penalty: {FORM}=symmetric:10000,symmetric:1000,"
     "symmetric:300,unsymmetric:20",
     "Grid/Occupation parameter=0.5,0.85,1",
     f"all but form and grid: {REFINED}=10:whole:2600:1:1e-6,"
     "5:trimmed:41600:0.5:1e-10",
     f"all but the grid: {REFINED},{FORM}=10:whole:2600:1:1e-6:symmetric:1000,"
     "5:trimmed:41600:0.5:1e-10:unsymmetric:20"),
    ("--at", "4", *HALF_FIXED.options[4:]),
    (),
    ("Tissue/Boundary points=2600,5200", "Time/Step=2,1"),
    HALF_FIXED.short_options)

GRADED = DocumentedScene(
    "prm/verification/graded-sphere.prm",
    ("Grid/Spacing=100,75,50,33,25",
     "Tissue/Cell spacing=20,14,10,7,5",
     "Time/Step=1,0.5,0.25,0.125", NEWTON + ",1e-9", LINEAR, OCCUPATION,
     "Grid/Spacing,Tissue/Cell spacing=100:20,75:15,50:10,35:7,25:5"),
    ("--repeat", "2", "--measure",
     "surface:mean(radius),surface:std(radius),mean_energy_density",
     "--wanted", "surface:mean(radius)=0.05um,mean_energy_density=1%"),
    ("accuracy",),
    ("Grid/Spacing=100,75", "Solver/Newton tolerance=1e-9,1e-2"),
    ("--measure", "surface:mean(radius),mean_energy_density",
     "-s", "Tissue/Cell spacing=25", "-s", "Grid/Spacing=100"))

PROLIFERATION = DocumentedScene(
    "prm/paper/fig-3b.prm",
    ("Grid/Spacing=100,50,33",
     "Tissue/Cell spacing=12.5,10,8",
     "Time/Step=0.2,0.1,0.05,0.025",
     "Solver/Newton tolerance=1e-2,1e-4,1e-6,1e-8",
     "Solver/Linear tolerance=0,1e-1,1e-2,1e-4",
     "Grid/Occupation parameter=0.5,0.85,1"),
    ("--at", "2", "--seeds", "1..8", "--jobs", "2", "--measure",
     "zmax,total_volume,mean_energy_density",
     "--wanted", "total_volume=1%,mean_energy_density=10%"),
    ("accuracy",),
    ("Grid/Spacing=100,50", "Time/Step=0.2,0.1"),
    ("--at", "0.6", "--seeds", "1..2", "--measure",
     "zmax,total_volume,mean_energy_density",
     "-s", "Tissue/Cell spacing=20"))

# The error bar of the first two, by where the grid lies.
METHODS = "Method=paper,consistent"
OFFSETS = DocumentedScene(
    HALF_FIXED.file, (METHODS,),
    ("--at", "2,4", "--offsets", "16", "--measure",
     "zmax,total_volume,mean_energy_density"),
    ("accuracy-day-4",),
    (METHODS,),
    ("--at", "2", "--offsets", "2", "--measure",
     "zmax,mean_energy_density", "-s", "Tissue/Cell spacing=20", "-s",
     "Grid/Spacing=100"))

SCENES = {"half-fixed-sphere": HALF_FIXED,
          "half-fixed-sphere-options": OPTIONS, "error-budget": BUDGET,
          "grid-offsets": OFFSETS, "graded-sphere": GRADED,
          "random-proliferation": PROLIFERATION}


def measure(name, options):
    """Runs the ladders of a scene and, if wanted, stores what they have
    measured; returns the exit code."""
    words = command(name, options)
    for option in ("jobs", "repeat"):
        if getattr(options, option):
            words += [f"--{option}", getattr(options, option)]
    typed = as_typed(words, options)
    print("contrib/accuracy " + shlex.join(typed), flush=True)
    if options.list:
        return 0
    if name == "graded-sphere":
        graded_sphere.write(ROOT / GRADED.file, graded_reference(options))
    output = options.output / (name + (".short" if options.short else ""))
    here = ["--morula", str(options.morula), "--output", str(output)]
    if options.again:
        here.append("--again")
    code = accuracy([*words, *here])
    if code == 0 and options.document:
        document(name, typed, output, options.morula)
    return code


def command(name, options):
    """The arguments of contrib/accuracy, without those that only say where
    things are."""
    scene = SCENES[name]
    words = [str(ROOT / scene.file)]
    for ladder in scene.short_ladders if options.short else scene.ladders:
        words += ["--vary", ladder]
    words += scene.short_options if options.short else scene.options
    return words + reference(name, options)


def reference(name, options):
    """Right values that do not come from Morula, where there are some."""
    if SCENES[name].file == HALF_FIXED.file:
        return ["--reference", str(ROOT / "doc/data/half-fixed-sphere.csv"),
                "--reference-column",
                "zmax=apex", "--reference-column", "time=10*(theta-1)"]
    if name == "graded-sphere":
        return ["--reference", str(graded_reference(options))]
    return []


def graded_reference(options):
    """Where the right values of the graded sphere are written."""
    return (options.output / "graded-sphere-reference.csv").resolve()


def as_typed(words, options):
    """The words as they are typed in the repository, whatever the working
    directory and the place of the output are now."""
    output = str(options.output.resolve())
    return [word.replace(output, "output/accuracy")
            .replace(f"{ROOT}/", "") for word in words]


def document(name, words, output, morula):
    """Stores the tables of a scene and puts its figures into their place."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    for figure in SCENES[name].figures:
        shutil.copy(output / f"{figure}.png", IMAGES / f"{name}-{figure}.png")
    found = (output / "table.md").read_text(encoding="utf-8")
    sections = re.split("^## ", found, flags=re.MULTILINE)[1:]
    if SCENES[name] is OFFSETS:
        sections = [s for s in sections if s.startswith("Scatter")]
    tables = "".join(f"#### {section}" for section in sections)
    store("accuracy-and-cost", {name: f"```\n{wrapped(words)}\n```\n\n{tables}"},
          made_with(ROOT, morula), ROOT)


def wrapped(words):
    """The command, an option a line."""
    lines = ["contrib/accuracy " + shlex.quote(words[0])]
    for word in words[1:]:
        if word.startswith("-"):
            lines.append("    " + word)
        else:
            lines[-1] += " " + shlex.quote(word)
    return " \\\n".join(lines)


STOPPED = 130  # exit code of contrib/accuracy after Ctrl-C


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="scene",
                        help="default: all; " + ", ".join(SCENES))
    parser.add_argument("--document", action="store_true",
                        help="write tables (doc/measured) and figures")
    parser.add_argument("--short", action="store_true",
                        help="few rungs, few seeds, large cells")
    parser.add_argument("--list", action="store_true",
                        help="print the commands")
    parser.add_argument("--again", action="store_true",
                        help="do not use runs from before")
    parser.add_argument("--jobs", help="runs at a time; default: one where "
                        "times count, else two")
    parser.add_argument("--repeat", metavar="N", help="times that each run is "
                        "done; default: twice where times count")
    parser.add_argument("--morula", type=Path, default=ROOT / "build/morula",
                        help="the executable")
    parser.add_argument("--output", type=Path,
                        default=ROOT / "output/accuracy")
    options = parser.parse_args()
    unknown = [name for name in options.scenes if name not in SCENES]
    if unknown:
        parser.error(f"there is no scene '{unknown[0]}'; there are "
                     + ", ".join(SCENES))
    if options.document and options.short:
        parser.error("the documentation shows the full ladders: without "
                     "--short")
    return options


def measure_all(options):
    """Measures the scenes; the largest of their exit codes, at once if the
    user stops one."""
    code = 0
    for name in options.scenes or SCENES:
        code = max(code, measure(name, options))
        if code == STOPPED:
            break
    return code


def main():
    try:
        return measure_all(arguments())
    except Refused as refusal:
        return f"accuracy-ladders: {refusal}"
