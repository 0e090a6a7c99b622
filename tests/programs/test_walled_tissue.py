# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""prm/examples/homeostasis.prm, crypt.prm and branching.prm: the height at which births
and extrusion balance, from below and from above, with a tissue that stays between its
walls; the flux through a crypt; branches where an inhibitor is low."""
import numpy
import pytest

from tests.common.program import TESTS

EXAMPLES = TESTS.parent / "prm/examples"
CSV = {"Output/Formats": "csv"}
ABOVE = {"Tissue/Center": "0, 140", "Tissue/Size": "100, 280"}


@pytest.mark.parametrize("start, keys", [
    (120, {}), pytest.param(280, ABOVE, marks=pytest.mark.release)])
def test_height(runs, start, keys):
    """H = H* + (H(0) - H*) exp(-k t), H* = 20 um + w (1 + b/k). Some 700 cells
    can be extruded: H has a standard deviation of 2 %."""
    run = runs.run(f"from-{start}", EXAMPLES / "homeostasis.prm",
                   {**CSV, "Time/End time": 6, **keys})
    table = run.statistics
    law = 212 + (start - 212) * numpy.exp(-0.5 * table["time"])
    height = table["total_volume"] / 100
    numpy.testing.assert_allclose(height, law, rtol=0.06)
    assert abs((height / law)[table["time"] > 1].mean() - 1) <= 0.03
    assert table["removed"].sum() > 800
    for number in range(7):
        assert abs(run.cells(number)["x"]).max() < 50
        surface = run.surface(number)
        assert abs(surface["x"]).max() < 50 + 12.5 / 4
        base = surface[surface["touched"] == 1]
        assert number == 0 or base["area"].sum() > 70
        assert (abs(base["y"]) < 12.5 / 4).all()


def test_crypt(runs):
    """What grows in 80 um at 0.7 a day goes up and out: 56 um a day, within two
    standard deviations of some 700 cells."""
    run = runs.run("crypt", EXAMPLES / "crypt.prm", CSV)
    table = run.statistics
    late = table[table["time"] > 3]
    size = (late["grown_volume"] / late["cells"]).mean()
    flux = late["removed"].sum() * size / 80 / 3
    assert abs(flux / 56 - 1) <= 0.075
    assert abs(table["total_volume"] / 80 - 225).max() < 10
    last = run.cells(12)
    assert abs(last["x"]).max() < 40
    error = last["signal"] - numpy.exp(-last["y"] / 60)
    assert numpy.sqrt((error**2).mean()) < 0.02


def test_branches(runs):
    """The corners of the bud run ahead of its sides."""
    run = runs.run("branching", EXAMPLES / "branching.prm", {**CSV, "Time/End time": 1.5})
    ratios = []
    for number in (0, 3):
        cells = run.cells(number)
        radius = numpy.hypot(cells["x"], cells["y"])
        angle = numpy.arctan2(cells["y"], cells["x"]) / (numpy.pi / 4)
        near = numpy.rint(angle).astype(int)
        across = abs(angle - near) < 0.2
        ratios.append(radius[across & (near % 2 == 1)].max()
                      / radius[across & (near % 2 == 0)].max())
    assert ratios[0] < 1.45
    assert ratios[1] > 2
