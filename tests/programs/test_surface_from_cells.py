# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The surface that is made from the cells: it encloses them, is held by walls where these
stand, closes cuts, and is the same on several ranks and after a resumption."""
import numpy
import pytest

from tests.common.program import assert_same_file

FLOWING = {"Dimension": 2, "Output/Formats": "csv", "Material/Energy per": "grown volume",
           "Material/Volumetric strain": "pooled", "Material/Relaxation time": 0.05}
SORTED = {**FLOWING, "Time/End time": 0.5, "Time/Step": 0.05, "Output/Interval": 0.25,
          "Tissue/Radius": 50, "Tissue/Cell spacing": 5, "Grid/Spacing": 15,
          "Grid/Offset": "3, 7", "Cell types/Names": "A, B", "Cell types/B/Where": "X > 0",
          "Cell types/A/Tension/With surface": 2, "Cell types/B/Tension/With surface": 4,
          "Cell types/B/Tension/With A": 1, "Rearrangement/Diffusion": 100,
          "Rearrangement/Fluctuation energy": 6, "Solver/Newton tolerance": 1e-9}
BOX = {**FLOWING, "Time/End time": 2, "Time/Step": 0.05, "Output/Interval": 2,
       "Tissue/Shape": "box", "Tissue/Center": "0, 60", "Tissue/Size": "100, 120",
       "Tissue/Cell spacing": 5, "Grid/Spacing": 15,
       "Boundary conditions/Fixed where": "Y < 0.1",
       "Boundary conditions/Slip where": "abs(X) > 49.9", "Growth/Law": "rate",
       "Growth/Rate/Rate": "0.7*(y > 20 && y < 100)", "Extrusion/Rate": "0.5*(y > 100)",
       "Division by size/Volume": 40, "Division by size/Noise": 0.1}
CUT = {"Dimension": 2, "Time/End time": 0.3, "Time/Step": 0.1, "Output/Formats": "csv",
       "Tissue/Radius": 60, "Tissue/Cell spacing": 10, "Tissue/Refine surface": "true",
       "Grid/Spacing": 30, "Boundary conditions/Pressure where": 1,
       "Boundary conditions/Pressure": 0.2, "Death/When": "X > 20 && t >= 0.1",
       "Death/Shrinking time": 0}
DISCS = {"Dimension": 2, "Time/End time": 0.1, "Time/Step": 0.02, "Tissue/Shape": "box",
         "Tissue/Size": "400, 200", "Tissue/Cell spacing": 5,
         "Tissue/Refine surface": "true", "Grid/Spacing": 15,
         "Death/When": "X^2 + Y^2 - 200*abs(X) > 0", "Death/Shrinking time": 0,
         "Material/Relaxation time": 0.1, "Boundary conditions/Surface tension": 1}


def share(run):
    """What the surface encloses of the cells' volume, in all rows."""
    return (run.statistics["enclosed_volume"] / run.statistics["total_volume"]).to_numpy()


@pytest.mark.parametrize("dim", [2, pytest.param(3, marks=pytest.mark.check)])
def test_cells_that_exchange_places_are_enclosed(runs, dim):
    keys = dict(SORTED) if dim == 2 else {
        **SORTED, "Dimension": 3, "Time/End time": 0.4, "Tissue/Radius": 40,
        "Tissue/Cell spacing": 9, "Grid/Spacing": 25, "Grid/Offset": "3, 7, 1",
        "Output/Interval": 0.2, "Rearrangement/Fluctuation energy": 60}
    run = runs.run(f"one-{dim}", keys)
    assert abs(share(run) / share(run)[0] - 1).max() <= (3e-3 if dim == 2 else 0.015)
    two = runs.run(f"two-{dim}", keys, ranks=2)
    for of in ("cells", "surface"):
        one, other = (getattr(of_run, of)(-1).sort_values("id") for of_run in (run, two))
        assert (one["id"].to_numpy() == other["id"].to_numpy()).all()
        assert abs(one[["x", "y", "z"]].to_numpy()
                   - other[["x", "y", "z"]].to_numpy()).max() <= 1e-6
    half = {**keys, "Time/End time": keys["Time/End time"] / 2}
    runs.run(f"resumed-{dim}", half)
    resumed = runs.run(f"resumed-{dim}", keys, {}, "--resume")
    for name in ("cells-0002.csv", "surface-0002.csv"):
        assert_same_file(run.directory / name, resumed.directory / name)


def test_walls_hold_by_place(runs):
    """Tissue grows up between walls and is shed at the top: it stays at them, as far as
    they go, and the surface closes at their corners."""
    run = runs.run("box", BOX)
    assert abs(share(run) - 1).max() <= 1e-3
    surface = run.surface(-1)
    n, area = surface[["nx", "ny"]].to_numpy(), surface["area"].to_numpy()
    assert abs((n * area[:, None]).sum(0)).max() <= 1e-3 * area.sum()
    side, base = (surface[surface["condition"] == kind] for kind in (2, 1))
    assert abs(abs(side["x"]) - 50).max() <= 0.3
    assert abs(base["y"]).max() <= 0.3
    top = run.cells(-1)["y"].max()
    assert side["y"].max() > top - 10
    assert side["y"].min() < 10
    assert abs(side["area"].sum() / (2 * top) - 1) <= 0.1
    assert abs(base["area"].sum() / 100 - 1) <= 0.05


def test_a_cut_is_closed(runs):
    """The pressure acts on the cut as on the rest of the surface, which stays tracked."""
    run = runs.run("cut", CUT)
    assert abs(share(run) / share(run)[0] - 1).max() <= 1e-3
    last = runs.run("cut-from-cells", {**CUT, "Tissue/Surface": "from cells"})
    both = [of.statistics.iloc[-1] for of in (run, last)]
    assert both[0]["xmax"] == pytest.approx(both[1]["xmax"], abs=0.1)
    assert both[0]["cell_mean_energy_density"] == pytest.approx(
        both[1]["cell_mean_energy_density"], rel=0.01)
    force = run.forces.iloc[-1]
    assert abs(force[["force_x", "force_y"]]).max() <= 1e-3
    assert force["force_inward"] == pytest.approx(0.2 * force["area"], rel=1e-3)


def test_the_first_step_knows_what_was_carved(runs):
    """Two discs that touch are carved from a box."""
    run = runs.run("discs", DISCS)
    assert run.statistics["rejected_steps"].sum() == 0
    assert abs(share(run) / share(run)[0] - 1).max() <= 1e-3


@pytest.mark.parametrize("keys, remade", [
    ({}, True), ({"Material/Relaxation time": 0}, False),
    ({"Boundary conditions/Fixed where": "X < -50"}, False),
    ({"Boundary conditions/Fixed where": "X < -50", "Death/Rate": 0.1}, True),
    ({"Boundary conditions/Traction where": "X > 50"}, False),
    ({"Method": "paper"}, False), ({"Tissue/Surface": "tracked"}, False),
    ({"Death/When": "X > 0", "Death/Shrinking time": 0,
      "Boundary conditions/Fixed where": "X < -50"}, False)])
def test_who_has_it(runs, keys, remade):
    said = runs.explain({**FLOWING, "Tissue/Radius": 60, "Grid/Spacing": 30, **keys})
    assert ("made from the cells" in said) == remade
