# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From 27 cells to 100,000."""
import numpy
import pytest

from tests.common.results import positions, read_csv, stresses

RATE = 0.3748  # 1/day: the root of 2 exp(-r) / (1 + r) = 1
# Elastic, this grid ends the run at 16,626 cells.
RELAXING = {"Material/Relaxation time": "0.05", "Grid/Spacing": "40",
            "Material/Volumetric strain": "pooled", "Grid/Offset": "20, 20, 20"}


def small(case, cells=1000):
    return {} if case.full else {"Time/Stop at cells": cells}


def enclosed(surface):
    return sum(numpy.sum(surface["area"] * surface["n" + x] * surface[x])
               for x in "xyz") / 3


def test_ball(case):
    trial = case.trial("ball", "from-27-cells.prm", small(case, 300))
    results, rows = trial.results, trial.rows
    cells, surface = results.last_cells(), results.last_surface()
    h = results.number("Grid/Spacing")

    # Renewal theory: ln N grows by RATE a day; each of the n cells there are adds a
    # scatter of about 0.5/sqrt(n) to what follows.
    t, n = rows["time"], rows["cells"]
    first = numpy.searchsorted(n, 100)
    if t[-1] - t[first] > 4:
        rate = numpy.polyfit(t[first:], numpy.log(n[first:]), 1)[0]
        case.found("growth rate of the number of cells against renewal theory [1/day]",
                   rate, equals=(RATE, 0.02))
    assert n[-1] >= results.number("Time/Stop at cells")
    case.found("initial volume lost, relative",
               abs(cells["initial_volume"].sum() / 27e3 - 1),
               at_most=1e-10)  # the digits of the files

    files = zip(results.outputs("cells"), results.outputs("surface"))
    worst = max(abs(enclosed(read_csv(s)) / read_csv(c)["volume"].sum() - 1)
                for c, s in files)
    case.found("volume inside the surface against that of the cells, largest relative "
               "difference", worst, at_most=0.06)
    trace = cells["volume"] * numpy.trace(stresses(cells), axis1=1, axis2=2)
    case.found("virial: sum of W tr tau over that of its magnitudes",
               abs(trace.sum()) / numpy.abs(trace).sum(), at_most=3e-3)
    case.found("smallest J_e", rows["min_elastic_volume_ratio"].min(), at_least=1e-3)

    x = positions(surface)
    x = x - numpy.average(x, axis=0, weights=surface["area"])
    moments = numpy.linalg.eigvalsh(numpy.einsum("a,ai,aj->ij", surface["area"], x, x))
    case.found("axes of the surface, longest over shortest",
               (moments[-1] / moments[0])**0.5, at_most=2.0)
    case.found("largest patch [of (h/2)^2]", surface["area"].max() / (h / 2)**2,
               at_most=1.0)
    # Boundary points are numbered through.
    assert (numpy.diff(surface["id"]) == 1).all()


@pytest.mark.release
def test_relaxing(case):
    """Where cells change places."""
    trial = case.trial("relaxing-ball", "from-27-cells.prm", {**RELAXING, **small(case)})
    case.found("relaxing: smallest J_e", trial.rows["min_elastic_volume_ratio"].min(),
               at_least=0.5)
    case.found("relaxing: mean energy at the end [kPa]",
               trial.last("mean_energy_density"), at_most=3e-3)


@pytest.mark.release
def test_box_on_a_fine_grid(case):
    """The corners of a box stand off from the cells, and on a fine grid nothing holds
    their points."""
    case.trial("box-on-a-fine-grid", "from-27-cells.prm", {
        "Tissue/Shape": "box", "Tissue/Size": "30, 30, 30",
        "Tissue/Lattice offset": "0, 0, 0", "Time/Stop at cells": "300",
        "Grid/Spacing": "25", "Grid/Offset": "12.5, 12.5, 12.5"}, exits=(0, 2),
        message="the step failed even at|left the tissue")
