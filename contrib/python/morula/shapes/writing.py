# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Files of regions: one a state, and one that lists them over time."""
import os

from morula.files import replaced, write
from morula.run import states
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

NAME = "cell-shapes"


def write_grid(grid, file):
    """Throws OSError if it cannot be written."""
    with replaced(file) as name:
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(name))
        writer.SetInputData(grid)
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
        if (not writer.Write() or writer.GetErrorCode() or not os.path.getsize(name)):
            raise OSError(f"{file} could not be written: is the disk full?")


def file_of(cells):
    """Where the regions of the cells in cells-NNNN.vtu or .csv are written."""
    return cells.with_name(cells.stem.replace("cells", NAME, 1) + ".vtu")


def write_collection(directory):
    """cell-shapes.pvd: all states of the run that have regions, not older than
    their cells, which a new run in the same directory replaces."""
    lines = []
    for time, cells in states(directory, "cells"):
        file = file_of(cells)
        if (file.is_file() and file.stat().st_mtime_ns >= cells.stat().st_mtime_ns):
            lines.append(f'    <DataSet timestep="{time:.10g}" group="" '
                         f'part="0" file="{file.name}"/>\n')
    collection = directory / f"{NAME}.pvd"
    write(collection, '<?xml version="1.0"?>\n<VTKFile type="Collection" '
          'version="0.1">\n  <Collection>\n' + "".join(lines)
          + "  </Collection>\n</VTKFile>\n")
    return collection
