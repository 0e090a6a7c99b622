# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that divide at a rate: their number, what the rate may read, several ranks, a
resumed run; a strip that makes a morphogen, and a tumour of cells that differ."""
import numpy
import pytest

from tests.common.program import TESTS, assert_same_run

EXAMPLES = TESTS.parent / "prm/examples"
ROOM = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "200, 200",
        "Tissue/Cell spacing": 10, "Tissue/Redistribution": "false", "Grid/Spacing": 50,
        "Time/End time": 1, "Time/Step": 0.125, "Output/Formats": "csv", "Output/Interval": 0.5}


def test_number_of_cells(runs):
    """Yule's process: the mean grows as exp(r t), and is known with its
    deviation; the events are those of the exact times, whatever the step."""
    rate, (short, long) = 1.2, (runs.run(f"yule-{step}", ROOM, {
        "Division/Rate": 1.2, "Time/Step": step}) for step in (0.125, 0.5))
    rows = short.statistics
    for time in (0.5, 1):
        n = rows["cells"][abs(rows["time"] - time) < 1e-9].iloc[0]
        mean = 400 * numpy.exp(rate * time)
        deviation = numpy.sqrt(mean * (numpy.exp(rate * time) - 1))
        assert abs(n - mean) < 3 * deviation
    times = [numpy.sort(run.lineage.birth_time) for run in (short, long)]
    numpy.testing.assert_allclose(*times, atol=1e-9)
    volume = short.cells(2)["initial_volume"] * 2.0**short.cells(2)["generation"]
    numpy.testing.assert_allclose(volume, 100, rtol=1e-6)


def test_waits_are_exponential(runs):
    born = runs.run("waits", ROOM, {"Division/Rate": "2*t"}).lineage.table
    first = born[born["generation"] == 1]["birth_time"].iloc[::2]
    # The integral of the rate, t^2, is exact at the ends of steps.
    for time in (0.5, 1):
        left = 1 - (first <= time).sum() / 400
        assert abs(left - numpy.exp(-time**2)) < 3 * numpy.sqrt(0.25 / 400)


def test_what_the_rate_reads(runs):
    cells = runs.run("reads", ROOM, {
        "Division/Rate": "99*(volume > 60)", "Cell types/Names": "a, b",
        "Cell types/b/Where": "X > 0", "Cell types/b/Division/Rate": 0}).cells(-1)
    assert set(cells[cells["type"] == 1]["generation"]) == {0}
    assert set(cells[cells["type"] == 0]["generation"]) == {1}


def test_on_ranks_and_resumed(runs):
    keys = {**ROOM, "Tissue/Size": "60, 60", "Growth/Law": "rate", "Growth/Rate/Rate": 1,
            "Division/Rate": "1 + pressure + volume/200", "Time/End time": 0.75,
            "Output/Interval": 0.25}
    one = runs.run("one", keys)
    assert len(one.cells(-1)) > 50
    for ranks in (2, 3):
        many = runs.run(f"{ranks}-ranks", keys, ranks=ranks)
        numpy.testing.assert_allclose(many.cells(-1), one.cells(-1), rtol=1e-6, atol=1e-6)
    assert_same_run(one, runs.resumed("parts", keys, {}, 0.5))


@pytest.mark.parametrize("other", [{"Proliferation/Law": "cell cycle"},
                                   {"Division by size/Volume": 200, "Growth/Law": "rate",
                                    "Growth/Rate/Rate": 1}])
def test_one_way_to_divide(runs, other):
    assert "as cells divide by the" in runs.refused(ROOM, {**other, "Division/Rate": 1})


def test_morphogen_strip(runs):
    """The field on tissue that does not grow, 1 - exp(-1) after 100 hours, and
    the shape of the one that does."""
    scene = EXAMPLES / "morphogen-strip.prm"
    still = runs.run("still", scene, {"Growth/Rate/Rate": 0, "Division/Rate": 0}).cells(-1)
    middle = still["c"][abs(still["x"]) < 6]
    assert abs(middle.mean() / (1 - numpy.exp(-1)) - 1) < 0.01
    last = runs.run("strip", scene).statistics.iloc[-1]
    assert 1.05 < (last["ymax"] - last["ymin"]) / (last["xmax"] - last["xmin"]) < 1.35


def test_selection_of_clones(runs):
    """Well fed, the mean oncoprotein rises as by the replicator equation of the
    founders' rates: with n_i(t) = exp(r p_i t)."""
    run = runs.run("clones", EXAMPLES / "heterogeneous-tumour.prm", {
        "Tissue/Radius": 250, "Fields/oxygen/Consumption": 1, "Time/End time": 2})
    p, rows = run.cells(0)["oncoprotein"], run.statistics
    assert abs(p.std() - 0.25) < 0.02
    for time in (1, 2):
        n = numpy.exp(0.7 * p * time)
        row = rows[abs(rows["time"] - time) < 1e-9].iloc[0]
        expected = (n * p).sum() / n.sum()
        assert expected > p.mean() + 0.035 * time
        assert abs(row["oncoprotein_mean"] / expected - 1) < 0.03
        assert abs(row["cells"] / n.sum() - 1) < 0.1
    # Daughters have what their founders had.
    cells = run.cells(-1)
    founders = run.cells(0).set_index("id")["oncoprotein"]
    numpy.testing.assert_allclose(cells["oncoprotein"], founders.loc[
        run.lineage.founder[cells["id"]]], rtol=1e-6)
