# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The same tissue on 1, 2 and 3 ranks, on larger scenes than the references:
several grid cells a rank, with cells that move from rank to rank.
"""
import pytest

from tests.common.program import SCENES, TESTS, assert_same_columns, assert_same_file

PAPER = SCENES.parents[1] / "prm/paper"
SMALL = TESTS / "programs/small-cube.prm"
PLACE = dict.fromkeys("xyz", 1e-6)
SURFACE = {**PLACE, "nx": 1e-6, "ny": 1e-6, "nz": 1e-6, "area": 1e-4,
           # kPa um^2, on patches of some 100 um^2
           **{f"force_{d}": 1e-4 for d in "xyz"}}


def run_on_all(runs, name, scene, keys):
    """The run on one rank, after comparison with those on more."""
    numbers = (1, 2, 3) if runs.options.ring == "release" else (1, 3)
    one, *others = (runs.run(f"{name}-{ranks}", scene, {
        "Output/Formats": "csv", "Output/Interval": 0, **keys}, ranks=ranks)
        for ranks in numbers)
    columns = one.cells(1).columns[11:]
    cells = {**PLACE, **dict.fromkeys(columns, 1e-6), "volume": 1e-4}
    for other in others:
        for file, near in (("lineage", PLACE), ("cells-0001", cells), ("surface-0001", SURFACE)):
            assert_same_columns(*(run.directory / f"{file}.csv" for run in (one, other)), near)
    assert (one.lineage.parent >= 0).sum() > 100
    return one


@pytest.mark.release
def test_cube(runs):
    """Fig. 3b with coarser cells, one day."""
    run_on_all(runs, "cube", PAPER / "fig-3b.prm", {
        "Time/End time": 1, "Time/Step": 0.2, "Tissue/Cell spacing": 20,
        "Tissue/Boundary points": 600, "Solver/Newton tolerance": 1e-10})


def test_refined_surface(runs):
    """The surface's points are split in mid-run, some of them held."""
    surface = run_on_all(runs, "refined", SMALL, {
        "Tissue/Refine surface": "true", "Tissue/Boundary points": 96, "Grid/Spacing": 32,
        "Solver/Newton tolerance": 1e-10}).surface(1)
    assert len(surface) > 96
    assert (surface["condition"] == 2).sum() > 16


def test_half_fixed_sphere_with_checkpoint(runs):
    """The checkpoint compares J_e with a threshold: equal decisions need
    tight solves. Until the first daughters wait, nothing is held."""
    run = run_on_all(runs, "sphere", PAPER / "fig-4b.prm", {
        "Tissue/Radius": 60, "Tissue/Cell spacing": 10, "Tissue/Boundary points": 0,
        "Grid/Spacing": 30, "Time/End time": 1.5, "Time/Step": 0.25,
        "Proliferation/Cell cycle/G0 exit rate": 2,
        "Proliferation/Cell cycle/Size checkpoint": 0.95, "Solver/Newton tolerance": 1e-12})
    assert run.statistics["held_at_checkpoint"].max() > 0


@pytest.mark.quick
def test_seed(runs):
    """Another seed gives another tissue, the same one the same bytes."""
    a, b, c = (runs.run(name, SMALL, {"Random seed": seed}).directory / "lineage.csv"
               for name, seed in (("a", 4), ("b", 4), ("c", 5)))
    assert_same_file(a, b)
    assert a.read_bytes() != c.read_bytes()
