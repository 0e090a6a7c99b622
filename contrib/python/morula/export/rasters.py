# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The regions of cells in voxels: a voxel has the label of the cell in whose
region its middle is, its id plus 1, or 0 outside of the tissue."""
from dataclasses import dataclass

import numpy as np

from morula.refusal import Refused
from morula.shapes.polyhedra import FLAT

SLACK = 1e-9  # um: a middle on a wall belongs to one of both cells, not to none
ROUND = 1e-6  # of a voxel: digits of files make no further row of voxels
MOST = 4e9    # bytes of an image


@dataclass(frozen=True)
class Raster:
    """Voxels of edges `voxel` (um); `low` is the corner (um) of the first one,
    `shape` their numbers; all in the order z, y, x, in 2-D y, x."""

    voxel: np.ndarray
    low: np.ndarray
    shape: tuple
    kind: type


def raster_around(boxes, voxel, largest):
    """The Raster of edges `voxel` (x, y, z; um) around boxes (low, high), with a border of one
    voxel; its corner is a multiple of the edges, so that images of several states fit on each
    other. `largest` is the largest label. Throws Refused for too many voxels."""
    voxel = np.asarray(voxel, dtype=float)
    low = np.floor(np.min([box[0] for box in boxes], axis=0) / voxel + ROUND) - 1
    high = np.ceil(np.max([box[1] for box in boxes], axis=0) / voxel - ROUND) + 1
    kind = np.uint16 if largest < 2**16 else np.uint32
    size = float(np.prod(high - low)) * np.dtype(kind).itemsize
    if size > MOST:
        raise Refused("--voxel", ",".join(f"{edge:g}" for edge in voxel),
                      f"images of at most {MOST / 1e9:g} GB",
                      f"This one would have {size / 1e9:.3g} GB: take larger voxels.")
    return Raster(voxel[::-1], (low * voxel)[::-1], tuple((high - low).astype(int)[::-1]), kind)


def box_of(bodies, dimension):
    """Low and high corner (x, y, z) of all regions, um."""
    corners = bodies.points[np.unique(bodies.corners), :dimension]
    return corners.min(axis=0), corners.max(axis=0)


def filled(raster, bodies, labels):
    """The image: regions, a polyhedron each in the order of the labels, are
    convex, so that a voxel is in one if it is behind all of its walls."""
    image = np.zeros(raster.shape, raster.kind)
    dim = len(raster.shape)
    bodies = bodies.select(bodies.beyond != FLAT)
    normals = bodies.area_vectors()
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    corners = bodies.points[bodies.corners[bodies.starts[:-1]]]
    offsets = np.einsum("ij,ij->i", normals, corners) + SLACK
    normals = normals[:, dim - 1::-1]  # z, y, x
    faces = np.searchsorted(bodies.owner, np.arange(len(labels) + 1))
    for cell, label in enumerate(labels):
        mine = slice(faces[cell], faces[cell + 1])
        places = bodies.points[bodies.corners[
            bodies.starts[mine.start]:bodies.starts[mine.stop]], dim - 1::-1]
        first = np.floor((places.min(axis=0) - raster.low) / raster.voxel)
        last = np.ceil((places.max(axis=0) - raster.low) / raster.voxel)
        box = tuple(slice(int(a), int(b)) for a, b in zip(first, last))
        middles = [raster.low[k] + (np.arange(part.start, part.stop) + 0.5)
                   * raster.voxel[k] for k, part in enumerate(box)]
        inside = np.ones([len(axis) for axis in middles], dtype=bool)
        for normal, offset in zip(normals[mine], offsets[mine]):
            inside &= sum(normal[k] * axis.reshape([-1 if j == k else 1 for j in range(dim)]) for k,
                          axis in enumerate(middles)) <= offset
        image[box][inside] = label
    return image
