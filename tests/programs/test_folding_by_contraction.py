# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/folding-by-contraction.prm with weak contraction: each hinge turns
the sheet by the angle of doc/theory.md (9.2)."""
import numpy

from tests.common.program import TESTS

SCENE = TESTS.parent / "prm/examples/folding-by-contraction.prm"
CONTRACTION, ZONE, THICKNESS = 0.02, 120.0, 40.0


def slope_of(cells, low, high):
    """Angle to the x axis of those cells that began between low and high: that of the
    rotation that fits best."""
    chosen = cells[(cells["X"] > low) & (cells["X"] < high)]
    X, Y, x, y = (chosen[name] - chosen[name].mean() for name in ("X", "Y", "x", "y"))
    return numpy.arctan2((X * y - Y * x).sum(), (X * x + Y * y).sum())


def test_angles(runs):
    cells = runs.run("sheet", SCENE, {
        "Contraction/Stretch": f"1 - {CONTRACTION}*t*if(Y > 0, abs(X) < 60, "
                               "abs(abs(X) - 180) < 60)",
        "Output/Interval": 1, "Output/Formats": "csv"}).cells(1)
    flanks = [slope_of(cells, low, low + 40) for low in (-290, -110, 70, 250)]
    hinges = numpy.diff(flanks) * [-1, 1, -1]
    expected = 1.5 * CONTRACTION * ZONE / THICKNESS
    numpy.testing.assert_allclose(hinges / expected, 1, atol=0.01, rtol=0)
    assert abs(flanks[0] + flanks[3]) <= 1e-6
