# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells over time as one file for ParaView and VTK: points in the layout of VTKHDF 2.0 for
PolyData in steps, in HDF5.

A state is a step of one part. Its points are the cells' places, µm, each with a vertex, so that
they are seen without a filter; the cells' other columns are data of the points, and the places in
the initial configuration one vector, `initial_position`, µm. The steps have the times of the
states, days."""
import numpy as np

from morula.files import replaced

# The kinds of cells of PolyData; only the first has any.
TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")
# A chunk of a column: 8,192 numbers of 8 bytes.
CHUNK = 8192


def write(run, numbers, file):
    """Writes these states of a Run; returns how many rows and columns. One state
    at a time is in memory."""
    import h5py
    with replaced(file) as aside, h5py.File(aside, "w") as out:
        root = out.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        # The reader takes a string of fixed length in ASCII alone.
        root.attrs.create("Type", np.bytes_("PolyData"))
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = np.int64(len(numbers))
        n_points, columns = 0, {}
        for step, number in enumerate(numbers):
            columns = _columns(run.cells(number))
            points = columns.pop("Points")
            _append_offsets(steps, run.times[number], step, n_points, columns)
            _append_points(root, points)
            for name, values in columns.items():
                _append(root, f"PointData/{name}", values)
            n_points += len(points)
    return n_points, len(columns)


def _columns(cells):
    """Places as "Points", (n, 3), then what the points have."""
    found = {name: cells.reindex(columns=[*axes], fill_value=0.0).to_numpy(float) for name, axes
             in (("Points", "xyz"), ("initial_position", "XYZ")) if axes[0] in cells}
    for name in cells:
        if name not in tuple("xyzXYZ"):
            found[name] = cells[name].to_numpy()
    return found


def _append_offsets(steps, time, step, n_points, columns):
    """Where a step begins in each of the datasets. It has as many vertices as points."""
    _append(steps, "Values", [float(time)])
    _append(steps, "PartOffsets", [step])
    _append(steps, "NumberOfParts", [1])
    _append(steps, "PointOffsets", [n_points])
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        _append(steps, name, [[n_points, 0, 0, 0]])
    for name in columns:
        _append(steps, f"PointDataOffsets/{name}", [n_points])


def _append_points(root, points):
    _append(root, "NumberOfPoints", [len(points)])
    _append(root, "Points", points)
    for name in TOPOLOGIES:
        n = len(points) if name == "Vertices" else 0
        _append(root, f"{name}/NumberOfCells", [n])
        _append(root, f"{name}/NumberOfConnectivityIds", [n])
        _append(root, f"{name}/Offsets", np.arange(n + 1))
        _append(root, f"{name}/Connectivity", np.arange(n))


def _append(group, name, rows):
    rows = np.asarray(rows)
    if name not in group:
        group.create_dataset(name, data=rows, maxshape=(None, *rows.shape[1:]),
                             chunks=(CHUNK, *rows.shape[1:]), compression="gzip")
        return
    data = group[name]
    data.resize(len(data) + len(rows), axis=0)
    data[len(data) - len(rows):] = rows
