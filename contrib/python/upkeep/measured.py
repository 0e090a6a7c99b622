# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Every page whose figures are measured, and what measures them."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Page:
    """A page below doc/ and the commands that measure its tables and figures,
    as words from the root of the tree on: all of them, and a few small runs
    through the same tools that show whether they work."""

    file: str
    full: tuple
    short: tuple


BUILT = ("--morula", "build/morula")

PAGES = {
    "reproduction": Page(
        "reproduction.md",
        (("contrib/reproduce", "--fresh", "--document", *BUILT),),
        (("contrib/reproduce", "--fresh", "--no-videos", *BUILT, "--jobs", "1",
          "-s", "Tissue/Cell spacing=50", "-s", "Grid/Spacing=100", "fig-1d",
          "fig-3a"),)),
    "showcase": Page(
        "showcase.md",
        (("contrib/upkeep/showcase", "--jobs", "2", "--document", *BUILT),),
        (("contrib/upkeep/showcase", *BUILT, "-s", "Tissue/Cell spacing=30",
          "-s", "Grid/Spacing=80", "-s", "Time/End time=1",
          "WM983b, 2500 cells"),)),
    "verification": Page(
        "verification.md",
        (("contrib/upkeep/cases", "verification", "--full", "--document"),),
        (("contrib/upkeep/cases", "verification/patch", "--plot"),)),
    "accuracy-and-cost": Page(
        "accuracy-and-cost.md",
        (("contrib/upkeep/accuracy-ladders", "--document", "--again"),),
        (("contrib/upkeep/accuracy-ladders", "--short", "--again", "grid-offsets"),)),
    "hard-cases": Page(
        "hard-cases.md",
        (("contrib/upkeep/cases", "hard", "--full", "--document"),),
        (("contrib/upkeep/cases", "hard/meshes", "--document"),)),
    "performance": Page(
        "performance.md",
        (("contrib/upkeep/benchmark", "--document"),),
        (("contrib/upkeep/benchmark", "--built", "--document", "--largest", "8000",
          "sizes"),)),
    "steps": Page(
        "steps/README.md",
        (("contrib/upkeep/step-pages",),),
        (("contrib/upkeep/step-pages", "1"),)),
    "half-fixed-sphere": Page(
        "half-fixed-sphere.md",
        (("contrib/upkeep/half-fixed-sphere",),),
        ()),  # its ladders take hours; tests/programs try the program
    "parameters": Page(
        "parameters.md",
        (("contrib/upkeep/parameters",),),
        (("contrib/upkeep/parameters",),)),
}
