# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The ladders of doc/accuracy-and-cost.md, as words of contrib/accuracy."""
import shlex

TOLERANCES = """--vary 'Solver/Newton tolerance=1e-2,1e-4,1e-6,1e-8{newton}'
    --vary 'Solver/Linear tolerance=0,1e-1,1e-2,1e-4{linear}'
    --vary 'Grid/Occupation parameter={occupation}'"""
FINE = TOLERANCES.format(newton=",1e-10", linear=",1e-8", occupation="0.2,0.5,0.7,0.85,1")
COARSE = TOLERANCES.format(newton="", linear="", occupation="0.5,0.85,1")
BOTH = "--vary 'Grid/Spacing,Tissue/Cell spacing=100:20,75:15,50:10,35:7,25:5'"
FORM = "Boundary conditions/Nitsche form,Boundary conditions/Nitsche penalty"
REFINED = ("Tissue/Cell spacing,Tissue/Surface cells,Tissue/Boundary points,Time/Step,"
           "Solver/Newton tolerance")
ROUGH, FINEST = "10:whole:2600:1:1e-6", "5:trimmed:41600:0.5:1e-10"
PENALTIES = "symmetric:10000,symmetric:1000,symmetric:300,unsymmetric:20"
MEASURES = "--measure zmax,total_volume,mean_energy_density"
REFERENCE = "--reference doc/data/half-fixed-sphere.csv"

LADDERS = {name: shlex.split(words) for name, words in {
    "half-fixed-sphere": f"""prm/paper/fig-2b.prm
    --vary Grid/Spacing=100,75,50,33,25 --vary 'Tissue/Cell spacing=20,14,10,7,5'
    --vary Time/Step=2,1,0.5,0.25 {FINE} {BOTH} -s 'Time/End time=2' {MEASURES} {REFERENCE}""",
    "half-fixed-sphere-options": f"""prm/paper/fig-2b.prm
    --vary Grid/Spacing=100,75,50,33,25
    --vary 'unsymmetric and trimmed: Grid/Spacing,{FORM},Tissue/Surface cells={",".join(
        f"{h}:unsymmetric:20:trimmed" for h in (100, 75, 50, 33, 25))}'
    --vary 'form and penalty: {FORM}=symmetric:1000,unsymmetric:40,unsymmetric:20,unsymmetric:10'
    --vary 'Grid/Points per cell=1,2' {MEASURES} {REFERENCE}""",
    "error-budget": f"""prm/paper/fig-2b.prm
    --vary 'cells: Tissue/Cell spacing,Tissue/Surface cells=10:whole,10:trimmed,5:trimmed'
    --vary 'Tissue/Boundary points=2600,10400,41600' --vary Time/Step=1,0.5,0.25
    --vary 'Solver/Newton tolerance=1e-6,1e-10' --vary 'Solver/Linear tolerance=0,1e-8'
    --vary 'form and penalty: {FORM}={PENALTIES}'
    --vary 'Grid/Occupation parameter=0.5,0.85,1'
    --vary 'all but form and grid: {REFINED}={ROUGH},{FINEST}'
    --vary 'all but the grid: {REFINED},{FORM}={ROUGH}:symmetric:1000,{FINEST}:unsymmetric:20'
    {MEASURES} {REFERENCE}""",
    "grid-offsets": f"""prm/paper/fig-2b.prm --vary Method=paper,consistent
    --offsets 16 {MEASURES} {REFERENCE}""",
    "graded-sphere": f"""prm/verification/graded-sphere.prm
    --vary Grid/Spacing=100,75,50,33,25 --vary 'Tissue/Cell spacing=20,14,10,7,5'
    --vary Time/Step=1,0.5,0.25,0.125
    {FINE.replace("1e-10'", "1e-10,1e-9'")} {BOTH}
    --measure 'surface:mean(radius),surface:std(radius),mean_energy_density'
    --reference doc/data/graded-sphere.csv""",
    "random-proliferation": f"""prm/paper/fig-3b.prm
    --vary Grid/Spacing=100,50,33 --vary 'Tissue/Cell spacing=12.5,10,8'
    --vary Time/Step=0.2,0.1,0.05,0.025 {COARSE} -s 'Time/End time=2'
    --seeds 1..8 --jobs 2 {MEASURES}""",
}.items()}
