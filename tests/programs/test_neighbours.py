# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What cells know of their neighbours, and what they do by it: columns by closed
forms on a lattice, on one rank and on several; lateral inhibition; that
scenes without them have nothing of it."""
import numpy
import pytest

from tests.common.program import TESTS

ALL = ("neighbours + neighbours_b + touching_b + unlike + free + around_x + around_type "
       "+ around_c")
LEAVE = "Cell types/b/Transitions/To a"
SCENE = {"Dimension": 2, "Time/End time": 0.2, "Time/Step": 0.1, "Tissue/Shape": "box",
         "Tissue/Size": "120, 100", "Tissue/Cell spacing": 10, "Grid/Spacing": 30,
         "Fields/Names": "c", "Fields/c/Diffusion": 1000, "Fields/c/Fixed where": "abs(X) > 59",
         "Fields/c/Value": "0.5 + X/120", "Cell types/Names": "a, b",
         "Cell types/b/Where": "X > 0",
         LEAVE: f"0*({ALL}) + 1e3*(slope_c > 0.0080 && slope_c < 0.0086)*(t > 0.1)",
         "Output/Formats": "csv", "Output/Interval": 0.1}
INHIBITION = TESTS.parent / "prm/examples/lateral-inhibition.prm"


def test_on_a_lattice(runs):
    one, three = (runs.run(f"on-{ranks}", SCENE, ranks=ranks) for ranks in (1, 3))
    cells = one.cells(0)
    x, y, kind = cells["x"], cells["y"], cells["type"]
    inside, rim = (abs(x) < 50) & (abs(y) < 40), abs(y) > 44
    left, right = inside & x.between(-6, 0), inside & x.between(0, 6)
    far = inside & (abs(x) > 6)
    for column, where, value in (
            ("neighbours", inside, 4), ("neighbours", rim & (abs(x) < 50), 3),
            ("neighbours", rim & (abs(x) > 54), 2), ("neighbours_b", left, 1),
            ("neighbours_b", right, 3), ("touching_b", left, 0.25), ("touching_b", right, 0.75),
            ("unlike", left, 0.25), ("unlike", right, 0.25), ("around_type", left, 0.25),
            ("around_type", right, 0.75), ("unlike", far, 0), ("free", inside, 0),
            ("neighbours_b", far, 4 * kind[far]),
            # linear things are their own means
            ("around_x", inside, x[inside]), ("around_c", inside, cells["c"][inside])):
        numpy.testing.assert_allclose(cells[column][where], value,
                                      atol=1e-6 if column == "around_c" else 1e-9)
    assert (cells["free"][rim] > 0.1).all()
    # slopes have no column, but are known: all have changed by them
    assert "slope_c" not in cells
    assert set(one.cells(2)["type"]) == {0}
    for number in (0, 1, 2):
        numpy.testing.assert_allclose(three.cells(number), one.cells(number), rtol=1e-8, atol=1e-8)


def test_by_radius(runs):
    cells = runs.run("radius", SCENE, {"Neighbours/Found by": "radius"}).cells(0)
    inside = (abs(cells["x"]) < 50) & (abs(cells["y"]) < 40)
    assert (cells["neighbours"][inside] == 8).all()


@pytest.mark.parametrize("size", [1000, pytest.param(2000, marks=pytest.mark.release)])
def test_lateral_inhibition(runs, size):
    """Random sequential adsorption on the square lattice covers 0.3641 of it,
    whatever the rate times step; no two stand beside each other."""
    cells = runs.run("inhibition", INHIBITION, {
        "Tissue/Size": f"{size}, {size}", "Output/Interval": 3, "Time/Step": 0.125,
        "Time/End time": 3}).cells(1)
    senders = cells["type"] == 1
    within = size / 2 - 50
    inside = (abs(cells["x"]) < within) & (abs(cells["y"]) < within)
    assert abs(senders[inside].mean() - 0.3641) <= 0.002
    assert cells["neighbours_sender"][senders].max() == 0
    # each that is undecided stays so for a sender beside it, but for the
    # few that had no time
    free = ~senders & (cells["neighbours_sender"] == 0)
    assert free.mean() < 1e-4


def test_inhibition_on_any_ranks(runs):
    """The events of one rank, of steps of any length while rates are constant:
    each has its exact time."""
    one, *others = (runs.run(f"{ranks}-{step}", INHIBITION, {
        "Tissue/Size": "300, 300", "Time/Step": step, "Time/End time": 1}, ranks=ranks)
        .events.sort_values(["id", "time"]) for ranks, step in ((1, 0.125), (3, 0.5)))
    assert len(one) > 250
    for other in others:
        numpy.testing.assert_allclose(other[["id", "time"]], one[["id", "time"]], atol=1e-12)


def test_absent(runs):
    """A scene of types that asks for nothing has no column, no section."""
    run = runs.run("absent", SCENE, {LEAVE: 1})
    assert not [name for name in run.cells(0) if name.startswith(
        ("neighb", "touch", "unlike", "free", "around", "slope"))]
    assert "commit" in run.timings.index
    assert not {"neighbours", "rearrangement", "type tension"} & {*run.timings.index}
    assert "exchanges" not in run.statistics
