# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/cell-shapes: regions are those of closed forms, fill the tissue, and
do not overlap. cell_shapes_files is about its files and options."""
from pathlib import Path

import numpy as np
from morula.run import Run
from morula.shapes.cutting import cut
from morula.shapes.polyhedra import SURFACE
from morula.shapes.regions import LEAST_WALL, places
from morula.shapes.voronoi import voronoi_regions
from tests.common.program import SCENES, ProgramTest, overrides
from scipy.spatial import ConvexHull, HalfspaceIntersection, cKDTree

from tests.common.shapes_file import POLYGON, POLYHEDRON, ShapesFile, face_area

ROOT = Path(__file__).resolve().parents[2]

CUBE = SCENES.parent / "programs/small-cube.prm"


class Cutting(ProgramTest):
    def test_against_half_spaces(self):
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
        volumes = bodies.volumes(positions)
        for i in range(60):
            corners = HalfspaceIntersection(np.array(spaces[i]),
                                            positions[i]).intersections
            self.assertAlmostEqual(volumes[i] / ConvexHull(corners).volume, 1,
                                   9)


def unit(vector):
    return vector / np.linalg.norm(vector)


def half_space(origin, normal):
    return np.append(normal, -normal @ origin)


class Regions(ProgramTest):
    def shapes(self, keys, *options):
        """Grows small-cube.prm with these keys; the run, the file of the state
        asked for, and what it holds."""
        output = self.work / "run"
        self.execute(CUBE, *overrides({"Time/End time": "0.125", **keys}),
                     output=output)
        file = self.work / "shapes.vtu"
        self.run_words([ROOT / "contrib/cell-shapes", output, "--output",
                        file, *options])
        return Run(output), ShapesFile(file)

    def check_lattice(self, sizes, keys):
        """Cubes (2-D: squares) of 10 um with the neighbours of a lattice."""
        dim = len(sizes)
        run, shapes = self.shapes({
            "Dimension": str(dim), "Proliferation/Law": "none",
            "Tissue/Center": ", ".join("5" for _ in sizes),
            "Tissue/Size": ", ".join(f"{10 * n}" for n in sizes),
            "Tissue/Cell spacing": "10", **keys}, "--time", "0")
        cells, volumes = run.cells(0), shapes.columns["region_volume"]
        np.testing.assert_allclose(volumes, 10.0**dim, rtol=1e-10)
        np.testing.assert_allclose(shapes.hull_volumes(dim), 10.0**dim,
                                   rtol=1e-10)
        self.assertAlmostEqual(volumes.sum() / np.prod(sizes) / 10.0**dim, 1,
                               10)
        for i, corners in enumerate(shapes.corners):
            offset = shapes.points[corners] - places(cells)[i]
            self.assertEqual(len(corners), 2**dim)
            np.testing.assert_allclose(np.abs(offset[:, :dim]), 5, rtol=1e-10)
        edge = np.array([10 * n for n in sizes]) / 2 - 5
        at_faces = np.sum(np.isclose(np.abs(places(cells)[:, :dim] - 5), edge),
                          axis=1)
        np.testing.assert_array_equal(shapes.columns["neighbours"],
                                      2 * dim - at_faces)
        np.testing.assert_array_equal(shapes.columns["touches_surface"],
                                      at_faces > 0)
        self.assertEqual({*np.unique(at_faces)}, {*range(dim + 1)})
        for name, values in cells.items():
            np.testing.assert_array_equal(shapes.columns[name], values)
        return shapes

    def test_box(self):
        shapes = self.check_lattice((4, 3, 5), {})
        self.assertEqual(shapes.kinds, {POLYHEDRON})
        self.assertEqual({len(faces) for faces in shapes.faces}, {6})

    def test_box_with_few_boundary_points(self):
        """Also with faces of three patches by four, coarser than the cells."""
        self.check_lattice((4, 3, 5), {"Tissue/Boundary points": "50"})

    def test_rectangle(self):
        shapes = self.check_lattice((7, 4), {"Boundary conditions/Slip where":
                                             "Y <= -15", "Boundary conditions/"
                                             "Slip normal": "0, 1"})
        self.assertEqual(shapes.kinds, {POLYGON})

    def sphere_excess(self, dim, points):
        """Of the volumes' sum over that of a sphere of 60 um (2-D: a disc)."""
        keys = {"Dimension": str(dim), "Proliferation/Law": "none",
                "Tissue/Shape": "sphere", "Tissue/Radius": "60",
                "Tissue/Center": ", ".join("0" * dim),
                "Tissue/Cell spacing": "10",
                "Tissue/Boundary points": str(points),
                "Boundary conditions/Slip where": "",
                "Boundary conditions/Slip normal": "",
                "Boundary conditions/Fixed where": ["Y", "Z"][dim - 2] + "<= 0"}
        _, shapes = self.shapes(keys, "--time", "0")
        exact = [np.pi * 60**2, 4 / 3 * np.pi * 60**3][dim - 2]
        volumes = shapes.columns["region_volume"]
        np.testing.assert_allclose(shapes.hull_volumes(dim), volumes,
                                   rtol=1e-8)
        return volumes.sum() / exact - 1

    def test_sphere(self):
        """Tangent planes stand outside of a sphere by r^2/(2 R) at a distance
        r from where they touch it. The mean of r^2 is A/(2 pi n) for n points
        on the area A, which makes 3/n of the volume; on a disc, where it is
        A^2/(12 n^2), pi^2/(3 n^2)."""
        for points in (400, 1600):
            excess = self.sphere_excess(3, points)
            self.assertGreater(excess * points / 3, 0.9)
            self.assertLess(excess * points / 3, 1.15)
        excess = self.sphere_excess(2, 36)
        self.assertAlmostEqual(excess * 3 * 36**2 / np.pi**2, 1, 1)

    def test_torus(self):
        """Its inner half is concave in a direction: there planes cut off a
        little that is inside, as elsewhere they leave a little that is
        outside. The volume is that of the mesh, by Gauss's theorem over its
        triangles; how much of it is in the inner half says Pappus's."""
        points, triangles = torus()
        self.write("torus.off", f"OFF\n{len(points)} {len(triangles)} 0\n"
                   + "".join(f"{x:.12g} {y:.12g} {z:.12g}\n"
                             for x, y, z in points)
                   + "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles))
        a, b, c = points[triangles.T]
        exact = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        _, shapes = self.shapes({
            "Proliferation/Law": "none", "Tissue/Shape": "mesh",
            "Tissue/Surface mesh": str(self.work / "torus.off"),
            "Boundary conditions/Slip where": "Z <= -25"}, "--time", "0")
        volumes = shapes.columns["region_volume"]
        self.assertLess(abs(volumes.sum() / exact - 1), 0.01)
        inner = np.hypot(*places(shapes.columns)[:, :2].T) < 60
        part = volumes[inner].sum() / volumes.sum()
        self.assertLess(abs(part - (0.5 - 4 * 26 / (6 * np.pi * 60))), 0.01)

    def test_grown(self):
        """A dome that has grown over its clamp, in single precision."""
        run, shapes = self.shapes({
            "Time/End time": "1.5", "Tissue/Shape": "sphere",
            "Tissue/Radius": "60", "Tissue/Center": "0, 0, 0",
            "Tissue/Cell spacing": "10", "Output/Formats": "vtu",
            "Boundary conditions/Slip where": "",
            "Boundary conditions/Fixed where": "Z <= 0"})
        cells, volumes = run.cells(-1), shapes.columns["region_volume"]
        self.assertGreater(len(volumes), 1200)
        np.testing.assert_allclose(shapes.hull_volumes(), volumes, rtol=1e-6)
        self.assertLess(abs(volumes.sum()
                            / run.statistics["total_volume"].iloc[-1] - 1),
                        0.01)
        self.assertGreater(volumes.min(), 0.01 * cells["volume"].min())
        self.check_nearest(places(cells), shapes)
        self.check_filled(places(cells), shapes)
        self.check_walls(shapes)

    def check_nearest(self, positions, shapes):
        """No corner is nearer to another cell than to its own: regions do not
        overlap."""
        tree = cKDTree(positions)
        for i, corners in enumerate(shapes.corners):
            own = np.linalg.norm(shapes.points[corners] - positions[i], axis=1)
            least = tree.query(shapes.points[corners])[0]
            self.assertLess((own - least).max(), 1e-6)

    def check_filled(self, positions, shapes):
        """Places between the middle and cells are in the region of the cell
        nearest to them."""
        random = np.random.default_rng(5)
        places_inside = random.uniform(0, 0.9, (1000, 1)) * positions[
            random.integers(len(positions), size=1000)]
        owner = cKDTree(positions).query(places_inside)[1]
        hulls = {i: shapes.hull(i).equations for i in set(owner)}
        for place, i in zip(places_inside, owner):
            self.assertLess((hulls[i][:, :3] @ place + hulls[i][:, 3]).max(),
                            1e-6)

    def check_walls(self, shapes):
        """Away from the surface the two cells of a wall have it with the same
        corners, and neighbours are the walls that are not tiny."""
        walls = {}
        for i, faces in enumerate(shapes.faces):
            for face in faces:
                walls.setdefault(frozenset(face), []).append(i)
        self.assertLessEqual(max(map(len, walls.values())), 2)
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
            self.assertEqual(shapes.columns["neighbours"][i], count)
            self.assertFalse(shapes.columns["touches_surface"][i])
        self.assertGreater(checked, len(volume) / 4)


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

