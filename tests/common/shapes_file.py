# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contrib/cell-shapes has written, read with VTK and nothing of ours."""
import numpy as np
from scipy.spatial import ConvexHull
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

POLYGON, POLYHEDRON = 7, 42  # VTK's numbers


class ShapesFile:
    """A cell-shapes-NNNN.vtu: points, of each cell the ids of its points and
    of the corners of its faces (in 2-D there are none), the columns."""

    def __init__(self, file):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        grid = reader.GetOutput()
        self.points = vtk_to_numpy(grid.GetPoints().GetData()).copy()
        self.kinds = {grid.GetCellType(i)
                      for i in range(grid.GetNumberOfCells())}
        ids = vtkIdList()
        self.corners, self.faces = [], []
        for i in range(grid.GetNumberOfCells()):
            grid.GetCellPoints(i, ids)
            self.corners.append(np.array([ids.GetId(k) for k in range(
                ids.GetNumberOfIds())]))
            if grid.GetCellType(i) == POLYHEDRON:
                grid.GetFaceStream(i, ids)
                self.faces.append(faces_of([ids.GetId(k) for k in range(
                    ids.GetNumberOfIds())]))
        data = grid.GetCellData()
        self.columns = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k))
                        for k in range(data.GetNumberOfArrays())}

    def hull(self, i, dim=3):
        """The convex hull of cell i's points."""
        return ConvexHull(self.points[self.corners[i], :dim])

    def hull_volumes(self, dim=3):
        return np.array([self.hull(i, dim).volume
                         for i in range(len(self.corners))])


def faces_of(stream):
    """Lists of corners, from the number of faces and for each one its number
    of corners and its corners."""
    result, place = [], 1
    for _ in range(stream[0]):
        result.append(stream[place + 1:place + 1 + stream[place]])
        place += 1 + stream[place]
    return result


def face_area(points):
    """Of a flat face with these corners in a circle, um^2."""
    arms = points[1:] - points[0]
    return 0.5 * np.linalg.norm(np.cross(arms[:-1], arms[1:]).sum(axis=0))
