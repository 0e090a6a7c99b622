# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From 27 cells to 100,000."""
import numpy

from tests.common.results import positions, read_csv, stresses
from tests.cases.case import Case, Finding, Limit, Trial

RATE = 0.3748  # 1/day: the root of 2 exp(-r) / (1 + r) = 1

VOLUME = Limit("The volume inside the surface is that of the cells to "
               "{at_most:g} of it, at all times.", at_most=0.06)
VIRIAL = Limit("The virial of the free ball vanishes to {at_most:g} of the "
               "sum of its magnitudes.", at_most=3e-3)
RELAXED = Limit("Where cells change places, no $J_e$ falls below "
                "{at_least:g}.", at_least=0.5)


def enclosed(surface):
    return sum(numpy.sum(surface["area"] * surface["n" + x] * surface[x])
               for x in "xyz") / 3


def judge(runs):
    results = runs["ball"].results
    rows = results.statistics()
    cells, surface = results.last_cells(), results.last_surface()
    h = results.number("Grid/Spacing")

    # Renewal theory: ln N grows by RATE a day; each of the n cells there are
    # adds a scatter of about 0.5/sqrt(n) to what follows.
    first = numpy.searchsorted(rows["cells"], 100)
    t, n = rows["time"], rows["cells"]
    if t[-1] - t[first] > 4:
        rate = numpy.polyfit(t[first:], numpy.log(n[first:]), 1)[0]
        yield Finding("growth rate of the number of cells against renewal "
                      "theory [1/day]", rate, equals=(RATE, 0.02))
    yield Finding("cells", n[-1],
                  at_least=results.number("Time/Stop at cells"))
    yield Finding("initial volume lost, relative",
                  abs(cells["initial_volume"].sum() / 27e3 - 1),
                  at_most=1e-10)  # the digits of the files

    files = zip(results.outputs("cells"), results.outputs("surface"))
    worst = max(abs(enclosed(read_csv(s)) / read_csv(c)["volume"].sum() - 1)
                for c, s in files)
    yield VOLUME.found("volume inside the surface against that of the cells, "
                       "largest relative difference", worst, error=True,
                       trial="ball")

    trace = cells["volume"] * numpy.trace(stresses(cells), axis1=1, axis2=2)
    yield VIRIAL.found("virial: sum of W tr tau over that of its magnitudes",
                       abs(trace.sum()) / numpy.abs(trace).sum())
    yield Finding("smallest J_e", rows["min_elastic_volume_ratio"].min(),
                  at_least=1e-3)

    x = positions(surface)
    x = x - numpy.average(x, axis=0, weights=surface["area"])
    moments = numpy.linalg.eigvalsh(numpy.einsum(
        "a,ai,aj->ij", surface["area"], x, x))
    yield Finding("axes of the surface, longest over shortest",
                  (moments[-1] / moments[0])**0.5, at_most=2.0)
    yield Finding("largest patch [of (h/2)^2]",
                  surface["area"].max() / (h / 2)**2, at_most=1.0)
    yield Finding("boundary points are numbered through",
                  numpy.abs(numpy.diff(surface["id"]) - 1).max(), at_most=0)

    rows = runs["relaxing-ball"].results.statistics()
    yield RELAXED.found("relaxing: smallest J_e",
                        rows["min_elastic_volume_ratio"].min())
    yield Finding("relaxing: mean energy at the end [kPa]",
                  rows["mean_energy_density"][-1], at_most=3e-3)


CASE = Case(
    title="From 27 cells to 100,000",
    judge=judge, limits=(VOLUME, VIRIAL, RELAXED),
    trials=[
        Trial("ball", "from-27-cells.prm",
              quick={"Time/Stop at cells": "1000"}),
        # Elastic, this grid ends the run at 16,626 cells.
        Trial("relaxing-ball", "from-27-cells.prm",
              keys={"Material/Relaxation time": "0.05",
                    "Material/Volumetric strain": "projected",
                    "Grid/Spacing": "40", "Grid/Offset": "20, 20, 20"},
              quick={"Time/Stop at cells": "1000"}),
        # The corners of a box stand off from the cells, and on a fine grid
        # nothing holds their points.
        Trial("box-on-a-fine-grid", "from-27-cells.prm", exit=(0, 2),
              keys={"Tissue/Shape": "box", "Tissue/Size": "30, 30, 30",
                    "Tissue/Lattice offset": "0, 0, 0",
                    "Time/Stop at cells": "300",
                    "Grid/Spacing": "25", "Grid/Offset": "12.5, 12.5, 12.5"},
              message="the step failed even at|left the tissue"),
    ])
