# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/cell-shapes: regions are those of closed forms, fill the tissue, and
do not overlap; its files and options, and what it refuses. contrib/render with
--shapes."""
import os
import re
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from morula.expressions import rows_where
from morula.refusal import Refused
from morula.shapes.cutting import cut
from morula.shapes.polyhedra import SURFACE
from morula.shapes.regions import LEAST_WALL, places
from morula.shapes.voronoi import voronoi_regions
from scipy.spatial import ConvexHull, HalfspaceIntersection, cKDTree
from tests.common.program import SCENES
from tests.common.shapes_file import POLYGON, POLYHEDRON, ShapesFile, face_area

CONTRIB = Path(__file__).resolve().parents[2] / "contrib"
CUBE = SCENES.parent / "programs/small-cube.prm"
STILL = {"Time/End time": 0.125, "Proliferation/Law": "none"}


def test_cutting_against_half_spaces():
    """Random regions, each cut by three random planes, against qhull's
    intersection of their half-spaces."""
    random = np.random.default_rng(3)
    positions = random.uniform(0, 10, (60, 3))
    bodies = voronoi_regions(positions, 1.0, flat=False)
    spaces = [[] for _ in positions]
    for owner, other in zip(bodies.owner, bodies.beyond):
        if other >= 0:
            spaces[owner].append(half_space(
                (positions[owner] + positions[other]) / 2,
                unit(positions[other] - positions[owner])))
    normals = [np.array([unit(n) for n in random.normal(size=(60, 3))])
               for _ in range(3)]
    normals += [s * np.tile(e, (60, 1)) for e in np.eye(3) for s in (1, -1)]
    for normal in normals:
        origin = positions + random.uniform(0.05, 2, (60, 1)) * normal
        bodies = cut(bodies, origin, normal, np.full(60, SURFACE))
        for i in range(60):
            spaces[i].append(half_space(origin[i], normal[i]))
    exact = [ConvexHull(HalfspaceIntersection(np.array(space), position).intersections).volume
             for space, position in zip(spaces, positions)]
    np.testing.assert_allclose(bodies.volumes(positions) / exact, 1, rtol=0, atol=5e-10)


def unit(vector):
    return vector / np.linalg.norm(vector)


def half_space(origin, normal):
    return np.append(normal, -normal @ origin)


def cell_shapes(runs, run, *words, code=0):
    done = runs.call([CONTRIB / "cell-shapes", run.directory, *words], code)
    assert "Traceback" not in done.stderr
    return done


def shapes_of(runs, name, keys, *words):
    """Grows small-cube.prm with these keys; the run, and the regions."""
    run = runs.run(name, CUBE, {"Time/End time": 0.125, **keys})
    file = runs.work / f"{name}.vtu"
    cell_shapes(runs, run, "--output", file, *words)
    return run, ShapesFile(file)


@pytest.mark.parametrize("name, sizes, keys", [
    ("box", (4, 3, 5), {}),
    # also with faces of three patches by four, coarser than the cells
    ("coarse", (4, 3, 5), {"Tissue/Boundary points": 50}),
    ("rectangle", (7, 4), {"Boundary conditions/Slip where": "Y <= -15",
                           "Boundary conditions/Slip normal": "0, 1"})])
def test_lattice(runs, name, sizes, keys):
    """Cubes (2-D: squares) of 10 um with the neighbours of a lattice."""
    dim = len(sizes)
    run, shapes = shapes_of(runs, name, {
        **STILL, "Dimension": dim, "Tissue/Center": ", ".join("5" for _ in sizes),
        "Tissue/Size": ", ".join(f"{10 * n}" for n in sizes),
        "Tissue/Cell spacing": 10, **keys}, "--time", "0")
    cells, volumes = run.cells(0), shapes.columns["region_volume"]
    np.testing.assert_allclose(volumes, 10.0**dim, rtol=1e-10)
    np.testing.assert_allclose(shapes.hull_volumes(dim), 10.0**dim, rtol=1e-10)
    assert len(volumes) == np.prod(sizes)
    for i, corners in enumerate(shapes.corners):
        offset = shapes.points[corners] - places(cells)[i]
        assert len(corners) == 2**dim
        np.testing.assert_allclose(np.abs(offset[:, :dim]), 5, rtol=1e-10)
    edge = np.array([10 * n for n in sizes]) / 2 - 5
    at_faces = np.sum(np.isclose(np.abs(places(cells)[:, :dim] - 5), edge), axis=1)
    np.testing.assert_array_equal(shapes.columns["neighbours"], 2 * dim - at_faces)
    np.testing.assert_array_equal(shapes.columns["touches_surface"], at_faces > 0)
    assert {*np.unique(at_faces)} == {*range(dim + 1)}
    for column, values in cells.items():
        np.testing.assert_array_equal(shapes.columns[column], values)
    assert shapes.kinds == {POLYHEDRON if dim == 3 else POLYGON}
    assert {len(faces) for faces in shapes.faces} == ({6} if dim == 3 else set())


@pytest.mark.parametrize("dim, points, low, high", [
    (3, 400, 0.9, 1.15), (3, 1600, 0.9, 1.15), (2, 36, 0.95, 1.05)])
def test_sphere(runs, dim, points, low, high):
    """Tangent planes stand outside of a sphere by r^2/(2 R) at a distance
    r from where they touch it. The mean of r^2 is A/(2 pi n) for n points
    on the area A, which makes 3/n of the volume; on a disc, where it is
    A^2/(12 n^2), pi^2/(3 n^2)."""
    _, shapes = shapes_of(runs, f"sphere-{dim}-{points}", {
        **STILL, "Dimension": dim, "Tissue/Shape": "sphere", "Tissue/Radius": 60,
        "Tissue/Center": ", ".join("0" * dim), "Tissue/Cell spacing": 10,
        "Tissue/Boundary points": points, "Boundary conditions/Slip where": "",
        "Boundary conditions/Slip normal": "",
        "Boundary conditions/Fixed where": ["Y", "Z"][dim - 2] + "<= 0"}, "--time", "0")
    exact = [np.pi * 60**2, 4 / 3 * np.pi * 60**3][dim - 2]
    volumes = shapes.columns["region_volume"]
    np.testing.assert_allclose(shapes.hull_volumes(dim), volumes, rtol=1e-8)
    expected = 3 / points if dim == 3 else np.pi**2 / (3 * points**2)
    assert low < (volumes.sum() / exact - 1) / expected < high


def test_torus(runs):
    """Its inner half is concave in a direction: there planes cut off a
    little that is inside, as elsewhere they leave a little that is
    outside. The volume is that of the mesh, by Gauss's theorem over its
    triangles; how much of it is in the inner half says Pappus's."""
    points, triangles = torus()
    mesh = runs.write("torus.off", f"OFF\n{len(points)} {len(triangles)} 0\n"
                      + "".join(f"{x:.12g} {y:.12g} {z:.12g}\n" for x, y, z in points)
                      + "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles))
    a, b, c = points[triangles.T]
    exact = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    _, shapes = shapes_of(runs, "torus", {
        **STILL, "Tissue/Shape": "mesh", "Tissue/Surface mesh": mesh,
        "Boundary conditions/Slip where": "Z <= -25"}, "--time", "0")
    volumes = shapes.columns["region_volume"]
    assert abs(volumes.sum() / exact - 1) < 0.01
    inner = np.hypot(*places(shapes.columns)[:, :2].T) < 60
    part = volumes[inner].sum() / volumes.sum()
    assert abs(part - (0.5 - 4 * 26 / (6 * np.pi * 60))) < 0.01


@pytest.fixture(scope="module")
def grown(runs):
    """A dome that has grown over its clamp, in single precision."""
    return shapes_of(runs, "grown", {
        "Time/End time": 1.5, "Tissue/Shape": "sphere", "Tissue/Radius": 60,
        "Tissue/Center": "0, 0, 0", "Tissue/Cell spacing": 10, "Output/Formats": "vtu",
        "Boundary conditions/Slip where": "", "Boundary conditions/Fixed where": "Z <= 0"})


def test_grown_volumes(grown):
    run, shapes = grown
    cells, volumes = run.cells(-1), shapes.columns["region_volume"]
    assert len(volumes) > 1200
    np.testing.assert_allclose(shapes.hull_volumes(), volumes, rtol=1e-6)
    assert abs(volumes.sum() / run.statistics["total_volume"].iloc[-1] - 1) < 0.01
    assert volumes.min() > 0.01 * cells["volume"].min()


def test_grown_regions_do_not_overlap(grown):
    """No corner is nearer to another cell than to its own."""
    run, shapes = grown
    positions = places(run.cells(-1))
    tree = cKDTree(positions)
    for i, corners in enumerate(shapes.corners):
        own = np.linalg.norm(shapes.points[corners] - positions[i], axis=1)
        assert (own - tree.query(shapes.points[corners])[0]).max() < 1e-6


def test_grown_tissue_is_filled(grown):
    """Places between the middle and cells are in the region of the cell
    nearest to them."""
    run, shapes = grown
    positions, random = places(run.cells(-1)), np.random.default_rng(5)
    inside = random.uniform(0, 0.9, (1000, 1)) * positions[
        random.integers(len(positions), size=1000)]
    owner = cKDTree(positions).query(inside)[1]
    hulls = {i: shapes.hull(i).equations for i in set(owner)}
    for place, i in zip(inside, owner):
        assert (hulls[i][:, :3] @ place + hulls[i][:, 3]).max() < 1e-6


def test_grown_walls(grown):
    """Away from the surface the two cells of a wall have it with the same
    corners, and neighbours are the walls that are not tiny."""
    _, shapes = grown
    walls = {}
    for i, faces in enumerate(shapes.faces):
        for face in faces:
            walls.setdefault(frozenset(face), []).append(i)
    assert max(map(len, walls.values())) <= 2
    volume = shapes.columns["region_volume"]
    checked = 0
    for i, faces in enumerate(shapes.faces):
        pairs = [walls[frozenset(face)] for face in faces]
        if any(len(pair) < 2 for pair in pairs):
            continue
        checked += 1
        areas = [face_area(shapes.points[face]) for face in faces]
        count = sum(area > LEAST_WALL * volume[pair].min()**(2 / 3)
                    for area, pair in zip(areas, pairs))
        assert shapes.columns["neighbours"][i] == count
        assert not shapes.columns["touches_surface"][i]
    assert checked > len(volume) / 4


@pytest.mark.parametrize("size", ["12, 12, 12", "12, 24, 12"])
def test_single_cell(runs, size):
    """One cell, and two: no Voronoi diagram of their own."""
    _, shapes = shapes_of(runs, f"cells-{len(size)}-{size[4]}", {
        **STILL, "Tissue/Size": size, "Tissue/Center": "0, 0, 6"}, "--time", "0")
    np.testing.assert_allclose(shapes.hull_volumes(), 12.0**3, rtol=1e-9)
    np.testing.assert_array_equal(shapes.columns["neighbours"], len(shapes.corners) - 1)


def test_conditions():
    columns = {"x": np.array([-2.0, -1, 0, 3]), "id": np.arange(4)}
    x, number = columns["x"], columns["id"]
    for text, expected in {
            "x < 0 && id > 0": (x < 0) & (number > 0),
            "x<0||id==3": (x < 0) | (number == 3),
            "x": x > 0, "-x": x < 0, "x^2 - 2": x**2 > 2,
            "-2 < x <= 0 and id != 2": (-2 < x) & (x <= 0) & (number != 2),
            "abs(x) >= sqrt(4)": np.abs(x) >= 2, "1": x == x,
            "0": x != x, "(x + 3)/2*id > 1": (x + 3) / 2 * number > 1,
            "x/id > -1": np.divide(x, number, where=number > 0,
                                   out=np.full(4, -9.0)) > -1}.items():
        np.testing.assert_array_equal(rows_where(text, columns, "--where"), expected, text)
    for text in ("y > 0", "x >", "__import__('os')", "x if x", "[x]", "'x'", "x < 0 ! id", ""):
        with pytest.raises(Refused, match="columns are x, id"):
            rows_where(text, columns, "--where")


@pytest.fixture(scope="module")
def cube(runs):
    return runs.run("cube", CUBE, {"Output/Formats": "csv, vtu"})


def listed(run):
    """Times in cell-shapes.pvd, and that each has its file."""
    found = re.findall(r'timestep="(.*?)" .*file="(.*?)"',
                       (run.directory / "cell-shapes.pvd").read_text())
    assert [file for _, file in found] == [
        f"cell-shapes-{round(2 * float(time)):04}.vtu" for time, _ in found]
    return [float(time) for time, _ in found]


def test_states(runs, cube):
    """Single states, all, some cells; and columns from CSV and VTU."""
    cell_shapes(runs, cube, "--time", "0.5")
    assert listed(cube) == [0.5]
    cell_shapes(runs, cube)
    assert listed(cube) == [0.5, 1]
    cell_shapes(runs, cube, "--all")
    assert listed(cube) == [0, 0.5, 1]
    shapes = ShapesFile(cube.directory / "cell-shapes-0002.vtu")
    cells = cube.cells(2)
    assert {*shapes.columns} == {*cells, "sigma", "displacement", "region_volume",
                                 "neighbours", "touches_surface"}
    for name, values in cells.items():
        np.testing.assert_array_equal(shapes.columns[name], values)
    file = runs.work / "some.vtu"
    cell_shapes(runs, cube, "--where", "generation >= 1 && z > 30", "--output", file)
    some = ShapesFile(file)
    kept = (cells["generation"] >= 1) & (cells["z"] > 30)
    assert kept.sum() > 5
    for name, values in shapes.columns.items():
        np.testing.assert_array_equal(some.columns[name], values[kept])
    np.testing.assert_allclose(some.hull_volumes(), shapes.hull_volumes()[kept], rtol=1e-9)
    # regions of a run that was there before are not listed
    os.utime(cube.directory / "cell-shapes-0000.vtu", ns=(0, 0))
    cell_shapes(runs, cube)
    assert listed(cube) == [0.5, 1]


@pytest.mark.parametrize("words, texts", [
    (("--time", "0.3"), ("--time = '0.3'", "0, 0.5")),
    (("--time", "noon"), ("--time = 'noon'", "0, 0.5")),
    (("--time", "0.5", "--all"), ("--time", "--all")),
    (("--where", "speed > 1"), ("--where", "speed", "energy_density")),
    (("--where", "id < 0"), ("--where", "none of")),
    (("--all", "--output", "x.vtu"), ("--output", "single")),
    (("--output", "/nowhere/x.vtu"), ("/nowhere", "exists")),
    (("--output", "x.png"), ("x.png", ".vtu")),
    (("--shape",), ("--shape", "--help"))])
def test_refusals(runs, cube, words, texts):
    before = {*cube.directory.iterdir()}
    said = cell_shapes(runs, cube, *words, code=1).stderr
    assert all(text in said for text in texts)
    assert {*cube.directory.iterdir()} == before


def test_damaged(runs):
    """A message, exit code 1, and the files from before."""
    run = runs.run("damaged", CUBE, {"Output/Formats": "vtu", "Time/End time": 0.5})
    cell_shapes(runs, run)
    before = {file.name: file.read_bytes() for file in run.directory.iterdir()}
    cells = run.directory / "cells-0001.csv"
    rows = [line.split(",") for line in (runs.run("csv", CUBE, {"Time/End time": 0.5})
                                         .directory / cells.name).read_text().splitlines()]
    at = rows[0].index("x")
    rows[7][at:at + 3] = rows[9][at:at + 3]
    for name, text, words in (
            ("surface-0001.vtu", "", "not there"), ("surface-0001.vtu", "<VTKFile", "damaged"),
            ("cells-0001.vtu", "<VTKFile", "damaged")):
        file = run.directory / name
        file.write_text(text)
        if not text:
            file.unlink()
        assert words in cell_shapes(runs, run, code=1).stderr
        file.write_bytes(before[name])
    assert {file.name: file.read_bytes() for file in run.directory.iterdir()} == before
    csv = runs.work / "csv"
    (csv / cells.name).write_text("\n".join(map(",".join, rows)) + "\n")
    said = runs.call([CONTRIB / "cell-shapes", csv], 1).stderr
    assert "different places" in said
    assert not [*csv.glob("cell-shapes*")]


@pytest.mark.release
def test_pictures(runs):
    """Polyhedra leave no gaps: seen along an axis the box fills its
    rectangle, but for the edges that are drawn dark."""
    run = runs.run("picture", CUBE, STILL)

    def picture(*words):
        file = runs.work / "picture.png"
        runs.call([CONTRIB / "render", run.directory, "--width", "300", "--output", file,
                   "--time", "0", "--azimuth", "0", "--elevation", "0", *words])
        return matplotlib.image.imread(file)[:, :, :3]

    for more in ((), ("--cut",), ("--cut", "--section")):
        part = picture("--shapes", "--field", "neighbours", *more)
        part = part[150:300, 80:220]  # well inside the tissue
        assert (part.min(axis=2) > 0.95).mean() < 0.001
        assert part.std() > 0.02
    assert np.abs(picture() - picture("--shapes")).mean() > 0.005


def torus(radius=60, tube=26, n=72, m=36):
    """Points (um) and triangles, outward, of a torus round the z axis."""
    a, b = np.meshgrid(np.arange(n) * 2 * np.pi / n,
                       np.arange(m) * 2 * np.pi / m, indexing="ij")
    points = np.stack([(radius + tube * np.cos(b)) * np.cos(a),
                       (radius + tube * np.cos(b)) * np.sin(a),
                       tube * np.sin(b)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n), np.arange(m),
                                           indexing="ij"))
    corner = [(i + di) % n * m + (j + dj) % m
              for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return points, np.vstack([np.stack([corner[k] for k in ks], axis=1)
                              for ks in ((0, 1, 2), (0, 2, 3))])

