# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The states of cells and surface that a run has written: which there are,
and what is in one of them."""
import xml.etree.ElementTree as ElementTree

import numpy as np

from .columns import COMPONENTS
from .results import read_csv, time_of


class NoStates(Exception):
    """A run has written none of the states asked for."""


def states(directory, name):
    """(time in days, file) of every state written, from NAME.pvd or the CSV
    files; NAME is 'cells' or 'surface'. Throws NoStates."""
    collection = directory / f"{name}.pvd"
    if collection.is_file():
        found = [(float(node.get("timestep")), directory / node.get("file"))
                 for node in ElementTree.parse(collection).iter("DataSet")]
    else:
        found = [(time_of(file), file)
                 for file in directory.glob(f"{name}-[0-9]*.csv")]
        found = [state for state in found if state[0] is not None]
    if not found:
        raise NoStates(f"{directory} has no {name}.pvd and no {name}-*.csv; "
                       "was the run's Output/Formats = none?")
    return sorted(found)


def read_points(file):
    """Positions (n, 3) in um and the named columns of a VTU, PVTU or CSV
    file, in the file's order. Throws NoStates if the file is not there or
    damaged."""
    if not file.is_file():
        raise NoStates(f"{file} is not there, though a .pvd file lists it")
    if file.suffix == ".csv":
        data = read_csv(file)
        columns = {name: data[name] for name in data.dtype.names}
        return np.stack([columns[c] for c in "xyz"], axis=1), columns
    # VTK takes a second to load, and CSV files do without.
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import (vtkXMLPUnstructuredGridReader,
                                     vtkXMLUnstructuredGridReader)
    reader = (vtkXMLPUnstructuredGridReader if file.suffix == ".pvtu" else
              vtkXMLUnstructuredGridReader)()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    if reader.GetErrorCode() or grid.GetPoints() is None:
        raise NoStates(f"{file} is damaged: VTK cannot read it")
    point_data = grid.GetPointData()
    columns = {
        point_data.GetArrayName(i): vtk_to_numpy(point_data.GetArray(i))
        for i in range(point_data.GetNumberOfArrays())}
    positions = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    time = grid.GetFieldData().GetArray("TIME")
    return positions, {**columns_of_csv(positions, columns,
                                        time and time.GetValue(0)), **columns}


def columns_of_csv(positions, columns, time):
    """The columns that a VTU file has otherwise: as its points, as components,
    and once for all."""
    found = {name: positions[:, k] for k, name in enumerate("xyz")}
    for whole, parts in COMPONENTS.items():
        if whole in columns:
            found |= {name: columns[whole][:, k]
                      for k, name in enumerate(parts)}
    if time is not None:
        found["time"] = np.full(len(positions), time)
    return found
