# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Every page whose figures are measured, and what measures them."""
import shutil
from dataclasses import dataclass


@dataclass(frozen=True)
class Page:
    """A page below doc/ and the commands that renew it, as words from the root
    of the tree on: all of it, and a few small runs through the same tools that
    show whether they work. `after`, called with the root and tables.renew,
    puts into the page what no command does."""

    file: str
    full: tuple
    short: tuple
    after: object = None


def reproduction(root, renew):
    """The table and the figures of contrib/reproduce."""
    found = (root / "output/paper/table.md").read_text(encoding="utf-8")
    renew(root / "doc/reproduction.md",
          {"reproduction": found[found.index("## Numbers"):].rstrip()})
    for figure in (root / "output/paper").glob("fig-[1234]*.png"):
        if (root / "doc/images/paper" / figure.name).is_file():
            shutil.copy(figure, root / "doc/images/paper")


def half_fixed_sphere(root, renew):
    """The tables of contrib/half-fixed-sphere, in its order."""
    found = (root / "output/half-fixed-sphere/tables.md").read_text(
        encoding="utf-8")
    tables = [text for text in found.split("\n\n") if text.strip()]
    names = ("reference", "ladders-1.1", "ladders-1.4", "sizes", "edges")
    renew(root / "doc/half-fixed-sphere.md",
          {name: text.strip() for name, text in zip(names, tables)})


BUILT = ("--morula", "build/morula")

PAGES = {
    "reproduction": Page(
        "reproduction.md",
        (("contrib/reproduce", "--fresh", *BUILT),),
        (("contrib/reproduce", "--fresh", "--no-videos", *BUILT, "--jobs", "1",
          "-s", "Tissue/Cell spacing=50", "-s", "Grid/Spacing=100", "fig-1d",
          "fig-3a"),),
        reproduction),
    "showcase": Page(
        "showcase.md",
        (("contrib/showcase", "--jobs", "2", "--document", *BUILT),),
        (("contrib/showcase", *BUILT, "-s", "Tissue/Cell spacing=30",
          "-s", "Grid/Spacing=80", "-s", "Time/End time=1",
          "WM983b, 2500 cells"),)),
    "verification": Page(
        "verification.md",
        (("contrib/verify", "--full", "--document"),),
        (("contrib/verify", "patch", "--plot"),)),
    "accuracy-and-cost": Page(
        "accuracy-and-cost.md",
        (("contrib/accuracy-ladders", "--document", "--again"),),
        (("contrib/accuracy-ladders", "--short", "--again", "grid-offsets"),)),
    "hard-cases": Page(
        "hard-cases.md",
        (("contrib/hard-cases", "--full", "--document"),),
        (("contrib/hard-cases", "meshes", "--document"),)),
    "performance": Page(
        "performance.md",
        (("contrib/benchmark", "--document"),),
        (("contrib/benchmark", "--built", "--document", "--largest", "8000",
          "sizes"),)),
    "steps": Page(
        "steps/README.md",
        (("contrib/step-pages",),),
        (("contrib/step-pages", "1"),)),
    "half-fixed-sphere": Page(
        "half-fixed-sphere.md",
        (("contrib/half-fixed-sphere",),),
        (),  # its ladders take hours; tests/programs try the program
        half_fixed_sphere),
    "parameters": Page(
        "parameters.md",
        (("contrib/parameters",),),
        (("contrib/parameters",),)),
}
