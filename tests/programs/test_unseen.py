# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Combinations of effects whose parts are tested elsewhere: what one of them
remembers, the other one must not forget."""
import numpy as np
import pytest

from tests.common.program import assert_same_run

BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Output/Formats": "none"}
FIELD = {"Fields/Names": "u", "Fields/u/Time": "transient"}
RATE, STRETCH = "Growth/Rate/Rate", "Growth/Isotropic/Stretch"


def test_growth_by_rates_that_relaxes(runs):
    """Between plates, growth at a rate is that by the stretch exp(r t/2),
    and the tissue's shear has all but gone long after growth has ended."""
    keys = {**BOX, "Time/End time": 2, "Time/Step": 0.05, "Output/Interval": 0.5,
            "Material/Relaxation time": 0.2,
            "Boundary conditions/Slip where": "abs(Y) > 49.9"}
    rate, stretch = (runs.run(law.split()[0], keys, {"Growth/Law": law, key: value})
                     .forces["force_inward"].to_numpy() for law, key, value in (
                         ("rate", RATE, "0.4*(t < 1)"),
                         ("isotropic", STRETCH, "exp(0.2*min(t, 1))")))
    np.testing.assert_allclose(rate, stretch, rtol=0.03, atol=0.01 * stretch.max())
    assert rate[1] > 1
    assert rate[-1] < 0.05 * rate[1]


def test_every_wait_begins_anew(runs):
    """A rate that is found in steps gives what a number gives."""
    keys = {**BOX, "Time/End time": 2, "Time/Step": 0.1, "Proliferation/Law": "cell cycle",
            "Proliferation/Cell cycle/Duration": 0.4}
    one, other = (runs.run("waits", keys, {"Proliferation/Cell cycle/G0 exit rate": rate})
                  .lineage.birth_time for rate in ("1.5", "1.5 + 0*t"))
    assert len(one) > 300
    np.testing.assert_allclose(one, other, atol=1e-9)


@pytest.mark.parametrize("step", [0.05, 0.025])
def test_uptake_that_depends_on_its_field(runs, step):
    """c' = -c^2/2 everywhere: c = 2/(1 + t)."""
    table = runs.run("uptake", BOX, {
        **FIELD, "Time/End time": 1, "Time/Step": step, "Fields/u/Diffusion": 100,
        "Fields/u/Initial": 2, "Fields/u/Consumption": "0.5*u"}).statistics
    np.testing.assert_allclose(table["u_mean"], 2 / (1 + table["time"]), rtol=0.6 * step)
    np.testing.assert_allclose(table["u_max"], table["u_min"], rtol=1e-6)


def test_transfer_is_that_of_the_end(runs):
    mean = runs.run("transfer", BOX, {
        **FIELD, "Time/End time": 0.6, "Time/Step": 0.1, "Fields/u/Diffusion": 1000,
        "Fields/u/Initial": 1, "Fields/u/Value": 0,
        "Fields/u/Transfer": "1000*(t > 0.45)"}).statistics["u_mean"]
    assert abs(mean[4] - 1) <= 5e-10
    assert mean[5] < 0.9


@pytest.mark.parametrize("along", [True, False])
def test_what_goes_along_when_cells_change_places(runs, along):
    """A field that hardly spreads stays with its cell, or with its place,
    and its amount is kept."""
    cells = runs.run(f"along-{along}", BOX, {
        **FIELD, "Time/End time": 1, "Time/Step": 0.1, "Output/Formats": "csv",
        "Cell types/Names": "a, b", "Cell types/b/Where": "X > 0",
        "Rearrangement/Diffusion": 200, "Fields/u/Diffusion": 1e-6,
        "Fields/u/Initial": "1 + (X > 0)", "Fields/u/Exchanged": str(along).lower()}).cells(-1)
    is_right = (cells.x > 0).to_numpy()
    is_b = (cells.type == 1).to_numpy()
    assert (is_right & ~is_b).sum() > 3
    np.testing.assert_allclose(cells.u, 1 + (is_b if along else is_right), rtol=1e-6)
    assert abs((cells.u * cells.volume).sum() - 15000) <= 5e-6


@pytest.mark.parametrize("when, lost, times, ranks", [
    ("X < 0", "fixed", 2, 2), ("X > 0", "pressure", 1, 1), ("Y > 0", "Fields", 0, 1)])
def test_cells_that_are_held_die(runs, when, lost, times, ranks):
    """The run goes on without what held or loaded the tissue, and says
    so, on any ranks; with some of the cells left it says nothing."""
    run = runs.run(f"die-{lost}", BOX, {
        "Time/End time": 0.3, "Time/Step": 0.1, "Output/Interval": 0.1,
        "Death/Shrinking time": 0, "Death/When": f"{when} && t > 0.05",
        "Boundary conditions/Fixed where": "X < -49.9",
        "Boundary conditions/Pressure where": "X > 49.9", "Boundary conditions/Pressure": 0.05,
        "Fields/Names": "u", "Fields/u/Diffusion": 1e4, "Fields/u/Consumption": 1,
        "Fields/u/Value": 1, "Fields/u/Fixed where": "X < -49.9"}, ranks=ranks)
    log = (run.directory / "log.txt").read_text()
    word = "acts on no boundary point any more, and did on 10 before"
    assert log.count(word) == times
    assert (f"Fields/u/Fixed where {word}" in log) == (lost == "fixed")
    if times:
        assert f"{lost} {word}" in log
        assert list(run.forces[run.forces.name == lost].points) == [10, 0, 0]
    assert len(run.statistics) == 4


def test_lumen_resumed(runs):
    keys = {**BOX, "Tissue/Shape": "sphere", "Tissue/Radius": 100, "Tissue/Inner radius": 60,
            "Tissue/Cell spacing": 6, "Grid/Spacing": 20, "Time/Step": 0.1,
            "Time/End time": 0.4, "Output/Formats": "csv", "Output/Interval": 0.1,
            "Boundary conditions/Lumen where": "X^2 + Y^2 < 80^2",
            "Boundary conditions/Lumen volume": "1 + 0.5*t"}
    whole = runs.run("whole", keys)
    assert_same_run(whole, runs.resumed("part", keys, {}, 0.2))
    volume = whole.statistics["lumen_volume"]
    np.testing.assert_allclose(volume / volume[0], 1 + whole.statistics["time"] / 2, rtol=1e-6)
