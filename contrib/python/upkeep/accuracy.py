# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The ladders of doc/accuracy-and-cost.md, as words of contrib/accuracy. The scene itself has
today's defaults, but for what an exact solution needs."""
import shlex

# What the paper's method and the defaults of 0.2.0 have in common, and what they differ by.
OLD = ("Tissue/Surface cells,Tissue/Refine surface,Material/Volumetric strain",
       "whole:false:pointwise")
GROWN = ("Material/Energy per", "initial volume")
BORN = ("Proliferation/Cell cycle/Stay inside surface,Tissue/Redistribution", "false:false")
FORM = "Boundary conditions/Nitsche form,Boundary conditions/Nitsche penalty"
PAPER = "symmetric:1000"
KEYS = tuple(",".join((OLD[0], GROWN[0], BORN[0], FORM)).split(","))


def old(*more, first="Grid/Spacing", rungs=("100", "75", "50", "33", "25"), name="0.2.0"):
    """A ladder of the keys of OLD and of `more`, with other rungs of the first key."""
    keys, values = zip(OLD, *more)
    return shlex.join(["--vary", f"{name}: {','.join([first, *keys])}=" + ",".join(
        ":".join([rung, *values]) for rung in rungs)])


PAIRS = ("100:20", "75:15", "50:10", "35:7", "25:5")
BOTH = "Grid/Spacing,Tissue/Cell spacing"
MEASURES = "--measure zmax,total_volume,mean_energy_density"
REFERENCE = "--reference doc/data/half-fixed-sphere.csv"
NEW = "-s Method=consistent"

LADDERS = {name: shlex.split(words) for name, words in {
    "half-fixed-sphere": f"""prm/paper/fig-2b.prm {NEW}
    --vary Grid/Spacing=100,75,50,33,25 --vary 'Tissue/Cell spacing=14,10,7'
    --vary Time/Step=2,1,0.5 {old(GROWN)} {old(GROWN, (FORM, PAPER), name="paper")}
    {MEASURES} {REFERENCE}""",
    "grid-offsets": f"""prm/paper/fig-2b.prm {NEW}
    {old(GROWN, first=FORM, rungs=("bounded:20", PAPER))} --offsets 16 {MEASURES} {REFERENCE}""",
    "graded-sphere": f"""prm/verification/graded-sphere.prm -s 'Tissue/Surface cells=trimmed'
    -s 'Tissue/Refine surface=true' -s 'Material/Volumetric strain=pooled'
    --vary Grid/Spacing=75,50,33 --vary 'Tissue/Cell spacing=14,10,7' --vary Time/Step=1,0.5,0.25
    --vary '{BOTH}={",".join(PAIRS)}' {old(first=BOTH, rungs=PAIRS)}
    --measure 'surface:mean(radius),surface:std(radius),mean_energy_density'
    --reference doc/data/graded-sphere.csv""",
    "random-proliferation": f"""prm/paper/fig-3b.prm {NEW} -s 'Time/End time=2'
    --vary Grid/Spacing=100,50,33 --vary Time/Step=0.2,0.1,0.05
    {old(GROWN, BORN, rungs=("100", "50", "33"))} --seeds 1..8 {MEASURES}""",
}.items()}
