# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The smooth closed surface of labelled tissue, and its cavities.

The tissue is filled with 1, smoothed by Gaussians, and cut at the level at which the surface
encloses just the cells' volume. All lengths are in um, all places in the order of the image's
axes."""
import re
from dataclasses import dataclass

import numpy as np
from scipy import ndimage, optimize, sparse, spatial
from skimage import measure, segmentation

from morula.refusal import Refused

from .labels import refuse_sizes

# In lengths of the mean cell:
SMOOTH = 0.25  # standard deviation of the Gaussian
GAP = 0.4      # gaps narrower than this are closed
STEP = 0.2     # edge of the cubes that are cut
LEVELS = (0.25, 0.75)
CLEAR = 1e-3   # no value of the field is nearer to the level


@dataclass
class Part:
    """A closed part of the surface: vertices (n, dim), facets (m, dim), and
    what it encloses; volume < 0: a cavity."""

    vertices: np.ndarray
    facets: np.ndarray
    volume: float

    @property
    def area(self):
        """um^(dim-1)"""
        corners = self.vertices[self.facets]
        edges = corners[:, 1:] - corners[:, :1]
        if edges.shape[1] == 1:
            return float(np.linalg.norm(edges[:, 0], axis=1).sum())
        return float(0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum())


def tissue_of(cells, smallest_cavity, fill_gaps, words, file):
    """The mask of the tissue, padded, and the padding in voxels: narrow gaps
    are closed, and small cavities filled."""
    pad = np.ceil(4 * cells.length / cells.voxel).astype(int)
    refuse_sizes(cells.labels.shape, cells.voxel, pad, file)
    mask = np.pad(cells.labels > 0, [(n, n) for n in pad])
    half = max(0.5 * GAP * cells.length, 1.01 * min(cells.voxel))
    wide = ndimage.distance_transform_edt(~mask, cells.voxel) <= half
    closed = mask | (ndimage.distance_transform_edt(wide, cells.voxel) > half)
    holes, n = ndimage.label(~closed)
    sizes = np.bincount(holes.ravel()) * cells.voxel.prod()
    small = sizes < smallest_cavity * cells.volumes.mean()
    small[[0, holes.flat[0]]] = False
    if small.any():
        words.append(f"{small.sum()} cavities are smaller than {smallest_cavity:g} cells, "
                     f"together {sizes[small].sum():.4g} um^{mask.ndim}: they are filled.")
        closed |= small[holes]
    gap = (closed & ~mask).sum() / mask.sum()
    if fill_gaps:
        _fill(cells, closed, pad, words)
    elif gap > 0.02:
        words.append(f"Narrow gaps between labels are {100 * gap:.3g} % of "
                     "the cells' volume: the surface lies closer to the cells "
                     "instead. --fill-gaps gives the gaps to the cells.")
    return closed, pad


def _fill(cells, closed, pad, words):
    inner = tuple(slice(n, -n) for n in pad)
    filled = closed[inner] & (cells.labels == 0)
    wide = segmentation.expand_labels(cells.labels, max(cells.labels.shape))
    cells.labels[filled] = wide[filled]
    counts = np.bincount(cells.labels.ravel())
    before = cells.volumes.sum()
    cells.volumes = counts[cells.numbers] * cells.voxel.prod()
    words.append("Narrow gaps are given to the labels beside them: cells grow "
                 f"by {100 * (cells.volumes.sum() / before - 1):.3g} %.")


class Field:
    """The smoothed tissue on cubes of an edge `step` (um): values, and the
    place of the first one."""

    def __init__(self, mask, pad, voxel, length):
        self.step = STEP * length
        sigma = np.maximum(SMOOTH * length, voxel) / voxel
        once = ndimage.gaussian_filter(mask.astype(np.float32), sigma)
        # The second moment of this kernel is 0: a Gaussian alone would move
        # curved surfaces towards their centres, and narrow every cavity.
        smooth = 2 * once - ndimage.gaussian_filter(once, sigma)
        size = np.array(mask.shape) * voxel
        axes = [np.arange(0.5 * edge, whole - 0.5 * edge, self.step)
                for edge, whole in zip(voxel, size)]
        where = np.meshgrid(*(axis / edge - 0.5 for axis, edge in zip(axes, voxel)), indexing="ij")
        self.values = ndimage.map_coordinates(smooth, where, order=3)
        self.origin = 0.5 * voxel - pad * voxel

    def at(self, places):
        """The values at places (n, dim)."""
        return ndimage.map_coordinates(self.values, ((places - self.origin) / self.step).T, order=1)

    def parts(self, level):
        """The closed parts of the surface at a level."""
        values = self.values.astype(float)
        near = np.abs(values - level) < CLEAR
        values[near] = level + np.where(values[near] < level, -CLEAR, CLEAR)
        return (self._outlines if values.ndim == 2 else self._meshes)(values, level)

    def _meshes(self, values, level):
        vertices, facets, _, _ = measure.marching_cubes(values, level, gradient_direction="ascent",
                                                        allow_degenerate=False)
        if _volume(vertices, facets) < 0:
            facets = facets[:, ::-1]
        links = sparse.coo_matrix(
            (np.ones(2 * len(facets)),
             (np.r_[facets[:, 0], facets[:, 1]],
              np.r_[facets[:, 1], facets[:, 2]])), [len(vertices)] * 2)
        _, part_of = sparse.csgraph.connected_components(links, False)
        for part in range(part_of.max() + 1):
            chosen = facets[part_of[facets[:, 0]] == part]
            used, renumbered = np.unique(chosen, return_inverse=True)
            places = self.origin + self.step * vertices[used]
            chosen = renumbered.reshape(-1, 3)
            yield Part(places, chosen, _volume(places, chosen))

    def _outlines(self, values, level):
        # the order of the axes is y, x: areas change their sign
        for line in measure.find_contours(values, level, positive_orientation="low"):
            places = self.origin + self.step * line[:-1]
            n = np.arange(len(places))
            facets = np.stack([n, np.roll(n, -1)], 1)
            yield Part(places, facets, _volume(places[:, ::-1], facets))


def _volume(vertices, facets):
    corners = (vertices - vertices.mean(0))[facets]
    return float(np.linalg.det(corners).sum() / (6 if corners.shape[1] == 3 else 2))


def surface_of(cells, mask, pad, words):
    """The parts of the surface that encloses the cells' volume, bodies first,
    and cells left out that it leaves outside."""
    field = Field(mask, pad, cells.voxel, cells.length)
    wanted = cells.volumes.sum()

    def excess(level):
        return sum(part.volume for part in field.parts(level)) - wanted

    low, high = LEVELS
    try:
        level = optimize.brentq(excess, low, high, xtol=1e-3)
    except ValueError:  # of one sign at both ends
        level = low if abs(excess(low)) < abs(excess(high)) else high
    parts = list(field.parts(level))
    parts = [part for part in parts if part.volume > 0 or -part.volume > 0.1 * cells.volumes.mean()]
    _keep_inside(cells, field, level, words)
    parts = _with_cells(parts, cells, words)
    if not parts:
        raise Refused("The image", "its cells", "cells side by side, as there "
                      "is a surface around them")
    enclosed = sum(part.volume for part in parts)
    words.append(f"The surface encloses {enclosed:.5g} um^{mask.ndim}, "
                 f"{enclosed / cells.volumes.sum():.4f} of the cells' volume.")
    return sorted(parts, key=lambda part: -part.volume)


def _keep_inside(cells, field, level, words):
    """Cells whose place is outside stand where the field of theirs is
    greatest; those that are outside as a whole are left out."""
    inside = field.at(cells.places) > level + CLEAR
    for row in np.flatnonzero(~inside):
        places = (np.argwhere(cells.labels == cells.numbers[row]) + 0.5) * cells.voxel
        values = field.at(places)
        if values.max() > level + CLEAR:
            cells.places[row], inside[row] = places[values.argmax()], True
    if not inside.all():
        words.append(f"{(~inside).sum()} labels lie outside of the smooth "
                     "surface as a whole, alone and small: they are left out.")
        cells.keep(inside)


def _with_cells(parts, cells, words):
    """Bodies without a cell's place, and the cavities in them, go."""
    holds = np.array([part.volume < 0 or contains(part, cells.places).any() for part in parts])
    if not holds.all():
        words.append(f"{(~holds).sum()} bodies hold no cell's place, such as "
                     "parts of torn labels: they are left out.")
    bodies = [part for part, held in zip(parts, holds) if held and part.volume > 0]
    return bodies + [part for part in parts if part.volume < 0 and any(
        contains(body, part.vertices[:1])[0] for body in bodies)]


def contains(part, places):
    """Whether places (n, dim) are inside of a closed part."""
    if places.shape[1] == 2:
        return measure.points_in_poly(places, part.vertices)
    from morula.draw.shading import cell_array, poly_data
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersModeling import vtkSelectEnclosedPoints
    closed = poly_data(part.vertices)
    closed.SetPolys(cell_array(part.facets))
    check = vtkSelectEnclosedPoints()
    check.SetInputData(poly_data(places))
    check.SetSurfaceData(closed)
    check.SetTolerance(1e-9)
    check.Update()
    return vtk_to_numpy(check.GetOutput().GetPointData().GetArray("SelectedPoints")) > 0


def read_parts(file, dim):
    """Of a closed surface in a file, in the order x, y, z. What lies in an odd number is inside."""
    from vtkmodules import vtkFiltersCore, vtkIOGeometry, vtkIOPLY
    from vtkmodules.util.numpy_support import vtk_to_numpy
    kind = file.suffix.lower()
    try:
        if dim == 2:
            return [Part(np.array([point.split() for point in ring.split(",")], dtype=float), None, 0)
                    for ring in re.findall(r"\(([^()]+)\)", file.read_text())]
        if kind == ".off":
            rows = [line.split() for line in re.sub("OFF|#.*", "", file.read_text()).splitlines()]
            (n, *_), *rows = [row for row in rows if row]
            facets = [(row[1], *pair) for row in rows[int(n):] for pair
                      in zip(row[2:int(row[0])], row[3:int(row[0]) + 1])]
            return [Part(np.array(rows[:int(n)], dtype=float), np.array(facets, dtype=int), 0)]
        reader = {".stl": vtkIOGeometry.vtkSTLReader, ".obj": vtkIOGeometry.vtkOBJReader}.get(
            kind, vtkIOPLY.vtkPLYReader)()
        reader.SetFileName(str(file))
        triangles = vtkFiltersCore.vtkTriangleFilter()
        triangles.SetInputConnection(reader.GetOutputPort())
        triangles.Update()
        places, lists = triangles.GetOutput().GetPoints(), triangles.GetOutput().GetPolys()
        return [Part(vtk_to_numpy(places.GetData()), vtk_to_numpy(
            lists.GetConnectivityArray()).reshape(-1, 3), 0)]
    except (ValueError, IndexError, TypeError, AttributeError, OSError) as error:
        raise Refused("--surface", file, "a closed surface as STL, OFF, PLY or OBJ, in 2-D WKT",
                      f"It cannot be read: {error}.") from None


def balls_around(cavity, others):
    """Balls that hold every vertex of a cavity and none of the other parts of
    the surface, as few as a greedy choice finds: (n, dim) centres, n radii."""
    tree = spatial.cKDTree(np.concatenate([part.vertices for part in others]))
    left = cavity.vertices
    # candidates: the middle, and a point inward of each vertex
    middle = left.mean(0)
    every = left[::max(1, len(left) // 400)]
    candidates = np.concatenate([[middle]] + [
        middle + share * (every - middle) for share in (0.4, 0.7, 0.9, 1.0)])
    radii = 0.9 * tree.query(candidates)[0]
    found = []
    while len(left):
        covered = np.linalg.norm(left[None] - candidates[:, None], axis=2) < 0.97 * radii[:, None]
        best = covered.sum(1).argmax()
        if not covered[best].any():
            return None  # a wall as thin as nothing
        found.append((candidates[best], radii[best]))
        left = left[~covered[best]]
    return found
