# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Regions as an unstructured grid of VTK: a polyhedron a cell, or a polygon."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_POLYGON, VTK_POLYHEDRON,
                                           vtkCellArray, vtkUnstructuredGrid)

from .polyhedra import FLAT, ranges


def grid_of(bodies, columns, kept, flat):
    """Of the cells of the mask `kept`, in their order, with these columns as
    cell data. The faces of `bodies` are in the order of their owners."""
    bodies = bodies.select(kept[bodies.owner])
    if flat:  # the top, which goes round counterclockwise seen from above
        bodies = bodies.select((bodies.beyond == FLAT)
                               & (bodies.points[bodies.corners[bodies.starts[:-1]]][:, 2] > 0))
    used, corners = np.unique(bodies.corners, return_inverse=True)
    points = bodies.points[used]
    if flat:
        points[:, 2] = 0
    grid = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    if flat:
        grid.SetCells(VTK_POLYGON, lists_of_points(bodies.starts, corners))
    else:
        add_polyhedra(grid, bodies, corners, len(points))
    for name, values in columns.items():
        array = numpy_to_vtk(np.ascontiguousarray(values[kept]), deep=True)
        array.SetName(name)
        grid.GetCellData().AddArray(array)
    return grid


def lists_of_points(starts, corners):
    """VTK's list of lists of points."""
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(starts.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(corners.astype(np.int64), deep=True))
    return cells


def add_polyhedra(grid, bodies, corners, number):
    """Gives the grid a polyhedron for each owner. VTK wants the points of each
    one, and a stream: for each polyhedron the number of faces, and for each
    face the number of corners and the corners."""
    owners, first, faces = np.unique(bodies.owner, return_index=True, return_counts=True)
    rank = np.repeat(np.arange(len(owners)), faces)

    pairs = np.unique(np.repeat(rank, bodies.counts) * number + corners)
    owner, points = np.divmod(pairs, number)
    starts = np.concatenate([[0], np.cumsum(np.bincount(owner))])

    # Before each face stand the corners of those before it, a number for each
    # of them, and one for each polyhedron up to its own.
    face_at = bodies.starts[:-1] + np.arange(len(rank)) + rank + 1
    cell_at = face_at[first] - 1
    stream = np.empty(len(owners) + len(rank) + len(corners), dtype=np.int64)
    stream[cell_at] = faces
    stream[face_at] = bodies.counts
    stream[ranges(face_at + 1, bodies.counts)] = corners
    kinds = numpy_to_vtk(np.full(len(owners), VTK_POLYHEDRON, dtype=np.uint8), deep=True)
    grid.SetCells(kinds, lists_of_points(starts, points),
                  numpy_to_vtkIdTypeArray(cell_at, deep=True),
                  numpy_to_vtkIdTypeArray(stream, deep=True))
