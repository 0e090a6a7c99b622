# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells keep their places, and their volumes fit their space: doc/theory.md,
section 6.11."""
import numpy as np
import pytest
from scipy.spatial import cKDTree

from tests.common.program import assert_same_run

DISC = {"Dimension": 2, "Time/End time": 4, "Time/Step": 0.05, "Tissue/Radius": 60,
        "Tissue/Cell spacing": 10, "Tissue/Refine surface": "true",
        "Tissue/Coarsen surface": "true", "Grid/Spacing": 40,
        "Material/Energy per": "grown volume", "Material/Volumetric strain": "pooled",
        "Material/Relaxation time": 0.05, "Growth/Law": "rate", "Growth/Rate/Rate": 0.693,
        "Division by size/Volume": 144, "Division by size/Noise": 0.15,
        "Proliferation/Cell cycle/Division axis": "random",
        "Output/Formats": "csv", "Output/Interval": 4}


def share_of_union(cells):
    """Area that the discs of the cells cover together, in parts of their sum: 0.91
    on a lattice, 0.63 for places by chance."""
    x, radii = cells[["x", "y"]].to_numpy(), np.sqrt(cells["volume"].to_numpy() / np.pi)
    random = np.random.default_rng(0)
    i = random.choice(len(x), 20000, p=radii**2 / (radii**2).sum())
    way = random.normal(size=(len(i), 2))
    way *= (np.sqrt(random.uniform(size=len(i))) / np.linalg.norm(way, axis=1))[:, None]
    distances, others = cKDTree(x).query(x[i] + way * radii[i][:, None], 30)
    return (1 / np.maximum(1, (distances < radii[others]).sum(axis=1))).mean()


@pytest.mark.parametrize("step", [0.05, 0.2])
def test_disc(runs, step):
    """After four generations cells stand evenly, whatever the step."""
    run = runs.run(f"disc-{step}", {**DISC, "Time/Step": step})
    table = run.statistics
    assert share_of_union(run.cells(-1)) > 0.82
    assert (table["close_neighbours"] == 0).all()
    assert table["density_error"].max() < 0.04
    np.testing.assert_allclose(table["enclosed_volume"] / table["total_volume"], 1,
                               atol=0.015)
    np.testing.assert_allclose(table["total_volume"] / table["grown_volume"], 1, atol=0.01)


def test_ranks_and_resume(runs):
    keys = {**DISC, "Time/End time": 1, "Output/Interval": 0.5}
    whole = runs.run("whole", keys)
    assert_same_run(whole, runs.resumed("parts", keys, {}, 0.5))
    two = runs.run("two", keys, ranks=2).cells(-1).sort_values("id")
    one = whole.cells(-1).sort_values("id")
    np.testing.assert_allclose(one[["x", "y", "volume"]], two[["x", "y", "volume"]], rtol=1e-6,
                               atol=1e-6)


def test_when(runs):
    """Elastic tissue whose cells do not divide has neither law, divided tissue the
    first one, and tissue that flows both; unless the scene says otherwise."""
    elastic = {"Dimension": 2, "Time/End time": 0.1, "Time/Step": 0.1, "Tissue/Radius": 60,
               "Growth/Law": "rate", "Growth/Rate/Rate": "0.5*(X > 0)", "Output/Formats": "none"}
    dividing = {**elastic, "Division by size/Volume": 150}
    flowing = {**elastic, "Material/Relaxation time": 0.1, "Material/Volumetric strain": "pooled",
               "Material/Energy per": "grown volume"}
    first, second = "close_neighbours", "density_error"
    for name, keys, wanted in [
            ("elastic", elastic, set()), ("dividing", dividing, {first}),
            ("flowing", flowing, {first, second}),
            ("paper", {**dividing, "Method": "paper", "Growth/Law": "rate"}, set()),
            ("off", {**flowing, "Tissue/Redistribution": "false"}, set()),
            ("on", {**elastic, "Tissue/Redistribution": "true"}, {first})]:
        assert {first, second} & {*runs.run(name, keys).statistics} == wanted, name


def test_closed_box_of_planes(runs):
    """Tissue that grows against its pressure and is shed with it fills a box of planes:
    no cell leaves through a corner, the volume is the room's, and p = p0 b/k."""
    walls = {"left": (-1, 0), "right": (1, 0), "base": (0, -1), "lid": (0, 1)}
    keys = {"Dimension": 2, "Time/End time": 6, "Time/Step": 0.1, "Tissue/Shape": "box",
            "Tissue/Size": "192, 192", "Tissue/Cell spacing": 8, "Grid/Spacing": 32,
            "Material/Energy per": "grown volume", "Material/Volumetric strain": "pooled",
            "Material/Relaxation time": 0.1, "Growth/Law": "rate", "Growth/Rate/Rate": 0.5,
            "Division by size/Volume": 92, "Division by size/Noise": 0.2,
            "Extrusion/Rate": "max(0, pressure)", "Obstacles/Names": ", ".join(walls),
            "Output/Formats": "csv", "Output/Interval": 1}
    for name, (x, y) in walls.items():
        keys.update({f"Obstacles/{name}/Shape": "plane",
                     f"Obstacles/{name}/Center": f"{96 * x}, {96 * y}",
                     f"Obstacles/{name}/Normal": f"{-x}, {-y}"})
    run = runs.run("box", keys)
    pressures = []
    for day in range(2, 7):
        cells = run.cells(day)
        assert abs(cells[["x", "y"]].to_numpy()).max() < 96.5
        assert abs(cells["volume"].sum() / 192**2 - 1) < 0.02
        trace = cells["sigma_xx"] + cells["sigma_yy"] + cells["sigma_zz"]
        pressures.append((-trace / 3 * cells["volume"]).sum() / cells["volume"].sum())
    assert abs(sum(pressures) / len(pressures) / 0.5 - 1) < 0.08
