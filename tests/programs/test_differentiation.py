# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/differentiation.prm, on a coarser lattice: as many cells age as
their rate says."""
import math

from tests.common.program import TESTS

SCENE = TESTS.parent / "prm/examples/differentiation.prm"
END = 1.8
PROGENITOR = 0


def hazard(age):
    """The integral of 1.5*hill(age, 1, 8), by the trapezoidal rule."""
    n = 200
    rates = [1.5 * a**8 / (1 + a**8) for a in (age * i / n for i in range(n + 1))]
    return age / n * (sum(rates) - (rates[0] + rates[-1]) / 2)


def test_numbers(runs):
    run = runs.run("aged", SCENE, {"Tissue/Cell spacing": 10, "Grid/Spacing": 40,
                                   "Output/Formats": "none"})
    events, cells = run.events, run.lineage.table
    assert {*events["from"]} == {"progenitor"}
    assert {*events["to"]} == {"aged", "pressed"}

    # How long each cell was a progenitor: until it changed or divided.
    end = {**dict(zip(cells["parent"], cells["birth_time"])),
           **dict(zip(events["id"], events["time"]))}
    young = cells[cells["type"] == PROGENITOR]
    spans = {cell: end.get(cell, END) - birth
             for cell, birth in zip(young["id"], young["birth_time"])}
    # Events less integrated rates are a martingale: their mean is 0, and
    # its variance the sum of the integrated rates.
    expected = sum(hazard(age) for age in spans.values())
    aged = events[events["to"] == "aged"]["id"]
    assert expected > 150
    assert abs(len(aged) - expected) < 3 * math.sqrt(expected)
    # 0.3 day: a chance of 1e-5 for all cells together.
    assert min(spans[cell] for cell in aged) > 0.3
