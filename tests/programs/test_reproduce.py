# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contrib/reproduce computes, on made-up values, and the command on coarse scenes."""
import math

import matplotlib.image
import numpy as np
import pandas
import pytest
from morula.draw.surface import triangles_of
from morula.execute import overrides
from morula.run import Run
from reproduction import catalogue, outline, panels, renewal
from tests.common.program import TESTS

CUBE = {"Tissue/Cell spacing": "40", "Tissue/Boundary points": "150", "Grid/Spacing": "100"}
SPHERE = {"Tissue/Cell spacing": "70", "Tissue/Boundary points": "300", "Grid/Spacing": "150"}


def spiral(n):
    """n points that are spread evenly over the unit sphere."""
    z = 1 - (2 * np.arange(n) + 1) / n
    angle = np.pi * (3 - math.sqrt(5)) * np.arange(n)
    return np.stack([np.sqrt(1 - z**2) * np.cos(angle), np.sqrt(1 - z**2) * np.sin(angle), z], 1)


class Surface:
    """A run whose boundary points began on a sphere and are moved."""

    def __init__(self, positions, initial):
        self.columns = pandas.DataFrame(np.hstack([positions, initial]), columns=list("xyzXYZ"))
        self.columns["condition"] = np.where(initial[:, 2] > 0, 0, 1)

    def surface(self, _):
        return self.columns


def test_renewal():
    """The rates are those of expected numbers of cells, after the start is forgotten."""
    for step in (0.05, 0.1, 0.25):
        _, cells = renewal.expected_cells(step, 40)
        assert math.log(cells[-1] / cells[-2]) / step == pytest.approx(renewal.rate(step), abs=1e-9)
    assert renewal.rate() == pytest.approx(renewal.rate(1e-5), abs=1e-5)
    # Until the first daughters divide: 1 + the share that has waited.
    time, cells = renewal.expected_cells(0.001, 1)
    assert np.abs(cells - 2 + np.exp(-np.clip(time - 0.5, 0, None))).max() < 2e-3


def test_outline():
    """An ellipsoid of revolution from points without symmetry."""
    r, z = outline.profile(Surface(spiral(2600) * [332, 332, 469], 250 * spiral(2600)), 0).T
    assert np.abs(np.hypot(r / 332, z / 469) - 1).max() < 1e-3
    assert (np.diff(z) >= 0).all()


def test_distances():
    """5 µm outward near the clamp count there, a turn about the axis does not."""
    unit = spiral(2600)
    angle = np.linspace(np.pi, 0, 1001)
    sphere = 250 * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    moved = (250 + 5 * (unit[:, 2:] < 0.4)) * unit @ [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]
    near, away = outline.distances(Surface(moved, 250 * unit), 0, sphere)
    assert outline.rms(near) == pytest.approx(5, abs=0.01)
    assert away.max() < 0.01
    # Beside, beyond the end, and on the corner of two sides.
    points = np.array([[1.0, 2], [-3, -4], [4, 0], [7, 7], [3, 2]])
    off = outline.to_polyline(points, np.array([[0.0, 0], [4, 0], [4, 3]]))
    assert off == pytest.approx([2, 5, 0, 5, 1])


def test_triangles():
    """All points are corners; the triangles enclose the ball."""
    points = 250 * spiral(2600)
    a, b, c = points[triangles_of(points)].transpose(1, 0, 2)
    assert len(a) == 2 * len(points) - 4
    enclosed = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert enclosed == pytest.approx(4 / 3 * np.pi * 250**3, rel=0.01)


def test_panels():
    assert set(panels.DRAW) == set(catalogue.PANELS)
    for scene in catalogue.scenes_of(catalogue.PANELS):
        assert (TESTS.parent / f"prm/paper/{scene}.prm").is_file()


def reproduce(runs, *words, keys, code=0):
    """The rows of the command's table by their first two fields."""
    runs.call([TESTS.parent / "contrib/reproduce", "--morula", runs.options.morula,
               "--output", runs.work, *words, *overrides(keys)], code)
    lines = (runs.work / "table.md").read_text().split("\n")
    rows = [line.strip("| ").split(" | ") for line in lines if line.startswith("|")]
    return {(row[0], row[1]): row[2:] for row in rows}


def test_a_panel(runs):
    rows = reproduce(runs, "fig-1d", keys=CUBE)
    assert rows["§2.3, Fig. 1 d", "N_p after the cycle / before"][:3] == ["2", "2", "1.000"]
    assert matplotlib.image.imread(runs.work / "fig-1d.png")[:, :, :3].std() > 0.03


@pytest.mark.release
def test_cubes(runs):
    """Figures and numbers of coarse cubes; a scene that fails keeps nothing else back."""
    (runs.work / "fig-2b").touch()  # no directory
    rows = reproduce(runs, "fig-1d", "fig-3c", "fig-2b", keys=CUBE, code=1)
    assert rows["§2.3, Fig. 1 d", "N_p after the cycle / before"][:3] == ["2", "2", "1.000"]
    run = Run(runs.work / "fig-3b").statistics
    fitted = run[(run["time"] > 2 - 1e-6) & (run["time"] < 4 + 1e-6)]
    rate, logarithm = np.polyfit(fitted["time"], np.log(fitted["cells"]), 1)
    ours = [float(rows["Fig. 3 c", f"N_p: {what}"][1]) for what in ("rate [1/day]", "factor")]
    assert ours == pytest.approx([rate, math.exp(logarithm)], rel=1e-3)
    assert rows["§2.5", "boundary points of the sphere"][1] == "not run"
    assert not (runs.work / "fig-2b.png").exists()
    (runs.work / "fig-2b").unlink()
    for panel in ("fig-1d", "fig-3c"):
        assert matplotlib.image.imread(runs.work / f"{panel}.png")[:, :, :3].std() > 0.03


@pytest.mark.release
def test_spheres(runs):
    """All of Fig. 2 and 4 and a video; nothing of it is done twice."""
    short = {**SPHERE, "Time/End time": "1", "Time/Step": "0.5", "Output/Interval": "0.5"}
    reproduce(runs, "fig-4", "video-2", keys=short)
    rows = reproduce(runs, "fig-2", keys={**SPHERE, "Time/End time": "1"})
    before = {file: file.stat().st_mtime_ns for name in ("*/statistics.csv", "*.ogv")
              for file in runs.work.glob(name)}
    reproduce(runs, "fig-4f", "video-2", keys=short)
    assert before == {file: file.stat().st_mtime_ns for file in before}
    assert rows["a", "150"] == rows["d", "150"]  # equal grids
    for figure in ("fig-2", "fig-4"):
        assert matplotlib.image.imread(runs.work / f"{figure}.png")[:, :, :3].std() > 0.03
    # A run that stopped early goes on.
    statistics = runs.work / "fig-2b/statistics.csv"
    start = statistics.read_text()
    reproduce(runs, "fig-2b", keys=SPHERE)
    assert statistics.read_text().startswith(start) and len(start) < statistics.stat().st_size
