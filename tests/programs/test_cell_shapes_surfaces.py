# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Which planes cut which region, on surfaces that make it hard: a gap, a hole,
a re-entrant edge, cells that are outside. No run: cells and boundary points are
made here."""
import numpy as np
import pytest
from morula.shapes.boundary import Boundary
from morula.shapes.regions import regions_of

EDGE = 10.0  # um, of the cells of all lattices


def lattice(low, high):
    """Cells of a box with these corners, um."""
    axes = [np.arange(a + EDGE / 2, b, EDGE) for a, b in zip(low, high)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)


def box_surface(low, high, patch=5.0):
    """Boundary points of a box, and their normals."""
    low, high = np.array(low, float), np.array(high, float)
    points, normals = [], []
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        u, v = np.meshgrid(*[np.arange(low[k] + patch / 2, high[k], patch)
                             for k in others], indexing="ij")
        for place, sign in ((low[axis], -1), (high[axis], 1)):
            face = np.full((u.size, 3), place)
            face[:, others[0]], face[:, others[1]] = u.ravel(), v.ravel()
            points.append(face)
            normals.append(np.tile(sign * np.eye(3)[axis], (u.size, 1)))
    return np.vstack(points), np.vstack(normals)


def spiral(radius, number):
    """Points spread evenly on a sphere, and unit vectors to them."""
    k = np.arange(number) + 0.5
    z, angle = 1 - 2 * k / number, np.pi * (1 + 5**0.5) * k
    across = np.sqrt(1 - z**2)
    unit = np.stack([across * np.cos(angle), across * np.sin(angle), z], -1)
    return radius * unit, unit


def regions(cells, surface, normals):
    return regions_of(cells, np.full(len(cells), EDGE**3),
                      Boundary(surface, normals), flat=False)


def test_gap():
    """Two boxes 1 um apart: as if each were alone."""
    boxes = [((0, 0, 0), (40, 30, 20)), ((0, 0, 21), (40, 30, 51))]
    surfaces = [box_surface(*box) for box in boxes]
    found = regions(np.vstack([lattice(*box) for box in boxes]),
                    *map(np.vstack, zip(*surfaces)))
    np.testing.assert_allclose(found.volume, EDGE**3, rtol=1e-10)
    alone = [regions(lattice(*box), *surface)
             for box, surface in zip(boxes, surfaces)]
    # The Voronoi wall between the boxes lies in the gap.
    np.testing.assert_array_equal(found.neighbours, np.concatenate(
        [part.neighbours for part in alone]))
    np.testing.assert_array_equal(found.touches_surface, np.concatenate(
        [part.touches_surface for part in alone]))


def test_thin_sheet():
    """A single layer of cells: both sides cut the same cell."""
    box = ((0, 0, 0), (60, 50, 10))
    found = regions(lattice(*box), *box_surface(*box, patch=10))
    np.testing.assert_allclose(found.volume, EDGE**3, rtol=1e-10)
    assert found.touches_surface.all()


def test_shell():
    """A sphere with a hole, concave everywhere: radii 80 and 45 um."""
    cells = lattice((-80, -80, -80), (80, 80, 80))
    distance = np.linalg.norm(cells, axis=1)
    cells = cells[(distance < 80) & (distance > 45)]
    outer, out = spiral(80, 1600)
    inner, away = spiral(45, 500)
    found = regions(cells, np.vstack([outer, inner]),
                    np.vstack([out, -away]))
    exact = 4 / 3 * np.pi * (80**3 - 45**3)
    assert abs(found.volume.sum() / exact - 1) < 0.01
    # planes cut off less than l^2/(6 rho) round the hole
    corners = found.bodies.points[np.unique(found.bodies.corners)]
    least = np.linalg.norm(corners, axis=1).min()
    assert least > 45 - 1e-6
    assert np.linalg.norm(corners, axis=1).max() < 80 + 2
    lost = exact + 3 / 1600 * 4 / 3 * np.pi * 80**3 - found.volume.sum()
    assert 0 < lost < 4 * np.pi * 45**2 * EDGE**2 / (6 * 45)


def test_reentrant_edge():
    """A box with a quarter missing. Its lattice's cells are cubes, also
    along the edge; moved by 3 um, those along the edge lose a part."""
    box = ((0, 0, 0), (80, 80, 30))
    points, normals = box_surface(*box)
    cells = lattice(*box)
    notch = box_surface((40, 40, 0), (90, 90, 30))

    def without_notch(places, slack):
        return ~np.all(places[:, :2] > 40 + slack, axis=1)

    outside = without_notch(points, 0)
    wall = (np.isclose(notch[0][:, :2], 40).any(axis=1)
            & (notch[0] < 80).all(axis=1))
    surface = (np.vstack([points[outside], notch[0][wall]]),
               np.vstack([normals[outside], -notch[1][wall]]))
    found = regions(cells[without_notch(cells, 0)], *surface)
    np.testing.assert_allclose(found.volume, EDGE**3, rtol=1e-10)

    moved = cells + [3, 3, 0]
    moved = moved[without_notch(moved, 0) & (moved[:, :2] < 80).all(axis=1)]
    found = regions(moved, *surface)
    total = 30 * (80**2 - 40**2)
    lost = total - found.volume.sum()
    # Regions at the edge reach 3 um beyond both planes: one of the two
    # takes 3 by 7 um of what is inside.
    assert lost == pytest.approx(30 * 3 * 7, abs=5e-7)
    at_edge = np.all(moved[:, :2] == 38, axis=1)
    np.testing.assert_allclose(found.volume[at_edge], EDGE * 7 * 10)


def test_cells_outside():
    """A cell 3 um outside of a face stands out and takes nothing from
    the volume of others beyond its Voronoi region; one that is lost far
    outside has a cube of its own."""
    box = ((0, 0, 0), (40, 40, 40))
    cells = np.vstack([lattice(*box), [[20, 20, 43], [20, 20, 400]]])
    found = regions(cells, *box_surface(*box))
    assert found.volume[:-2].sum() / 40**3 == pytest.approx(1, abs=0.05)
    assert 10 < found.volume[-2] < EDGE**3
    assert found.volume[-1] / EDGE**3 == pytest.approx(8, abs=5e-7)
    heights = [found.bodies.points[found.bodies.corners[np.repeat(
        found.bodies.owner == i, found.bodies.counts)]][:, 2]
        for i in range(len(cells) - 2)]
    assert max(map(np.max, heights)) < 40 + 1e-9
