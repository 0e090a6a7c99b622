# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Grid cells that change their class while tissue grows through them."""
import numpy
import pytest

from tests.hard.slab import slab

L_P = 4.0
# 60 µm hold 15 whole cells of 4 µm; shifted, the lattice fits neither the column nor
# the grid, and the surface's cells are trimmed.
LATTICES = {"fitting": {}, "shifted": {"Tissue/Lattice offset": "1.3, 1.7",
                                       "Tissue/Surface cells": "trimmed"}}
RATIOS = (1, 1.5, 2, 3.3, 5, 10)  # h / L_p
FEW = (("fitting", 2), ("shifted", 5))


def limits(ratio):
    """Of the largest deviation of a step's increment of the energy from the exact
    one, in units of the mean increment, of the energy and of the height, relative.
    Below two cells per grid spacing they say what is measured, not what is wanted."""
    if ratio >= 2:
        return 0.005, 0.001, 0.002
    return (0.3, 0.1, 0.02) if ratio > 1 else (1, 0.2, 0.02)


def errors(trial):
    rows = trial.rows
    heights, energies = numpy.array([slab(1 + 0.4 * t) for t in rows["time"]]).T
    found, increments = rows["mean_energy_density"], numpy.diff(energies)
    return (abs(numpy.diff(found) - increments).max() / increments.mean(),
            abs(found[-1] / energies[-1] - 1),
            abs(rows["ymax"][-1] / (60 * heights[-1]) - 1))


@pytest.mark.parametrize("lattice, ratio", [
    pytest.param(lattice, ratio,
                 marks=[] if (lattice, ratio) in FEW else pytest.mark.release)
    for lattice in LATTICES for ratio in RATIOS])
def test_growing_column(case, lattice, ratio):
    occupations = [0.85]
    if lattice == "shifted" and ratio in (1.5, 5):
        occupations = [0.05, 0.2, 0.5, 0.85, 1] if case.full else [0.05, 1]
    row = f"{lattice}, h/L_p = {ratio:g}"
    trials = [case.trial(
        f"{lattice}-{ratio:g}-{occupation:g}", "growing-column.prm",
        {"Grid/Spacing": f"{ratio * L_P:g}", "Grid/Occupation parameter": occupation,
         **LATTICES[lattice], **({} if case.full else {"Time/Step": "0.1"})},
        exits=(0, 2) if ratio < 2 else (0,), row=row) for occupation in occupations]
    for name, value, most in zip(("jump of the energy", "error of the energy",
                                  "error of the height"),
                                 numpy.max(list(map(errors, trials)), axis=0),
                                 limits(ratio)):
        case.found(f"{row}: {name}", value, at_most=most)
