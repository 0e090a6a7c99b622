# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells as annotated data (AnnData), which scanpy and squidpy read: HDF5 in the layout of anndata
0.8 and later.

A row is a cell in a state. `X` has the columns that are amounts, `var` their units; `obs` has what
a cell is: its id, mother, generation, phase and type; `obsm/spatial` where it is, µm."""
import numpy as np

from morula.columns import unit_of
from morula.files import replaced

# Of the cells' columns those that are no amounts; places stand in obsm.
OF_CELL = ("time", "id", "parent", "generation", "phase", "type", "held_at_checkpoint")
PLACES = ("x", "y", "z", "X", "Y", "Z")
WITH_NAMES = ("phase", "type", "held_at_checkpoint")


def write(run, numbers, file):
    """Writes these states of a Run."""
    import h5py
    import pandas
    cells = pandas.concat([run.cells(i).assign(time=run.times[i]) for i in numbers],
                          ignore_index=True)
    amounts = [name for name in cells if name not in OF_CELL + PLACES]
    names = [f"cell-{cell}" + (f"@{time:g}" if len(numbers) > 1 else "")
             for cell, time in zip(cells["id"], cells["time"])]
    with replaced(file) as aside, h5py.File(aside, "w") as out:
        _mark(out, "anndata", "0.1.0")
        _array(out, "X", cells[amounts].to_numpy(dtype=np.float64))
        uns = _group(out, "uns")
        about = _group(uns, "morula")
        for name, text in (("run", run.name), ("length", "um"), ("time", "day")):
            _texts(about, name, text, "string")
        of_cell = [name for name in OF_CELL if name in cells]
        obs = _frame(out, "obs", names, of_cell)
        for name in of_cell:
            _observation(obs, uns, name, cells[name].to_numpy(), run.type_names)
        var = _frame(out, "var", amounts, ["unit"])
        _column(var, "unit", [unit_of(name, run.dimension) for name in amounts])
        places = _group(out, "obsm")
        for name, axes in (("spatial", "xyz"), ("initial", "XYZ")):
            axes = [axis for axis in axes[:run.dimension] if axis in cells]
            if axes:
                _array(places, name, cells[axes].to_numpy(dtype=np.float64))
        for name in ("layers", "obsp", "varm", "varp"):
            _group(out, name)
    return len(cells), len(amounts)


def _observation(obs, uns, name, values, type_names):
    """A column of obs; numbers that stand for something by its name, with the
    colours that pictures have."""
    if name not in WITH_NAMES:
        _column(obs, name, values)
        return
    from morula.draw.colours import meanings
    known = meanings(name, type_names, values)
    numbers = sorted(known)
    group = _group(obs, name, "categorical", "0.2.0")
    group.attrs["ordered"] = False
    _array(group, "codes", np.searchsorted(numbers, values).astype(np.int16))
    _texts(group, "categories", [known[number][0] for number in numbers])
    _texts(uns, f"{name}_colors", [known[number][1] for number in numbers])


def _mark(element, kind, version):
    element.attrs["encoding-type"] = kind
    element.attrs["encoding-version"] = version


def _group(parent, name, kind="dict", version="0.1.0"):
    group = parent.create_group(name)
    _mark(group, kind, version)
    return group


def _array(parent, name, values):
    _mark(parent.create_dataset(name, data=values, compression="gzip"
                                if values.size else None), "array", "0.2.0")


def _texts(parent, name, texts, kind="string-array"):
    import h5py
    _mark(parent.create_dataset(name, data=np.array(texts, dtype=object),
                                dtype=h5py.string_dtype()), kind, "0.2.0")


def _frame(parent, name, index, columns):
    import h5py
    group = _group(parent, name, "dataframe", "0.2.0")
    group.attrs["_index"] = "_index"
    group.attrs.create("column-order", columns, dtype=h5py.string_dtype())
    _texts(group, "_index", index)
    return group


def _column(frame, name, values):
    if len(values) and isinstance(values[0], str):
        _texts(frame, name, values)
    else:
        _array(frame, name, np.asarray(values))
