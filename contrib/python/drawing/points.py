# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The cells and the surface that a run has written, as arrays."""
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import (vtkXMLPUnstructuredGridReader,
                                 vtkXMLUnstructuredGridReader)


class NoStates(Exception):
    """A run has written none of the states asked for."""


def states(directory, name):
    """(time, file) of every state written, from NAME.pvd or the CSV files;
    NAME is 'cells' or 'surface'."""
    collection = directory / f"{name}.pvd"
    if collection.is_file():
        found = [(float(node.get("timestep")), directory / node.get("file"))
                 for node in ElementTree.parse(collection).iter("DataSet")]
    else:
        found = []
        for file in directory.glob(f"{name}-*.csv"):
            with file.open() as stream:
                stream.readline()
                found.append((float(stream.readline().split(",")[0]), file))
    if not found:
        raise NoStates(f"{directory} has no {name}.pvd and no {name}-*.csv; "
                       "was the run's Output/Formats = none?")
    return sorted(found)


def read_points(file):
    """Positions (n, 3) and the named columns of a VTU, PVTU or CSV file."""
    if file.suffix == ".csv":
        data = np.genfromtxt(file, delimiter=",", names=True)
        data = np.atleast_1d(data)
        columns = {name: data[name] for name in data.dtype.names}
        return np.stack([columns[c] for c in "xyz"], axis=1), columns
    reader = (vtkXMLPUnstructuredGridReader if file.suffix == ".pvtu" else
              vtkXMLUnstructuredGridReader)()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    point_data = grid.GetPointData()
    columns = {
        point_data.GetArrayName(i): vtk_to_numpy(point_data.GetArray(i))
        for i in range(point_data.GetNumberOfArrays())}
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float), columns


def radii_of(volumes, flat=False):
    """Radii (µm) of the spheres, in 2-D of the discs, of these volumes."""
    volumes = np.asarray(volumes, dtype=float)
    return (np.sqrt(volumes / np.pi) if flat else
            np.cbrt(0.75 * volumes / np.pi))
