# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A run that has been done, as data frames of pandas.

    from morula.run import Run
    run = Run("output/bud")
    run.statistics["total_volume"]      # um^3, an entry a step
    cells = run.cells(-1)               # the last state written
    cells["energy_density"].mean()      # kPa

The columns are those of the files (doc/README.md, "What a run writes").

What stands outside of the class reads single files into NumPy arrays: for
tools and tests that start often, as loading pandas takes half a second.
"""
import hashlib
import json
import xml.etree.ElementTree as ElementTree
from functools import cached_property
from pathlib import Path

import numpy as np

from .cell_types import names_in, read_events
from .columns import COMPONENTS
from .lineage import Lineage
from .prm import parse
from .refusal import Refused

ERRORS = "errors.json"  # of morula accuracy
ESSENTIAL = ("parameters.prm", "statistics.csv")

# Written as numbers, and whole ones.
WHOLE = ("id", "parent", "generation", "phase", "type", "condition", "held_at_checkpoint")

# Two times are equal if they agree to this, relative to the larger of them
# and a day.
TIME_SLACK = 1e-9


class NoStates(Refused):
    """A run has written none of the states asked for."""

    def __init__(self, text):
        Exception.__init__(self, text)


def read_csv(file):
    """The columns of a CSV file of numbers by name, a structured array; one
    row still makes arrays. Throws Refused if the file is damaged."""
    with open(file, encoding="utf-8") as stream:
        names = stream.readline().strip().split(",")
        try:
            return np.loadtxt(stream, delimiter=",", ndmin=1,
                              dtype=[(name, float) for name in names])
        except ValueError as error:
            raise Refused("The table", file, "a line of names and lines of "
                          "as many numbers", f"{error}.") from None


def same_time(a, b):
    return abs(a - b) <= TIME_SLACK * max(1.0, abs(a), abs(b))


def row_at(statistics, time):
    """Number of the row of statistics.csv at a time."""
    for number, there in enumerate(statistics["time"]):
        if same_time(there, time):
            return number
    raise LookupError(f"statistics.csv has no row for day {time:g}")


def time_of(file):
    """The time of a CSV file of cells or surface, or None if nothing is in it."""
    with file.open(encoding="utf-8") as stream:
        stream.readline()
        first = stream.readline()
    return float(first.split(",")[0]) if first else None


def states(directory, name):
    """(time in days, file) of every state written, from NAME.pvd or the CSV
    files; NAME is 'cells' or 'surface'. Throws NoStates."""
    collection = directory / f"{name}.pvd"
    if collection.is_file():
        found = [(float(node.get("timestep")), directory / node.get("file"))
                 for node in ElementTree.parse(collection).iter("DataSet")]
    else:
        found = [(time_of(file), file) for file in directory.glob(f"{name}-[0-9]*.csv")]
        found = [state for state in found if state[0] is not None]
    if not found:
        raise NoStates(f"{directory} has no {name}.pvd and no {name}-*.csv; "
                       "was the run's Output/Formats = none?")
    return sorted(found)


def read_points(file):
    """The columns of a VTU, PVTU or CSV file by name, in the file's order.
    Throws NoStates if the file is not there or damaged."""
    if not file.is_file():
        raise NoStates(f"{file} is not there, though a .pvd file lists it")
    if file.suffix != ".csv":
        return _read_vtu(file)
    data = read_csv(file)
    return {name: data[name] for name in data.dtype.names}


def places(columns):
    """Positions (n, 3), um."""
    return np.stack([columns[c] for c in "xyz"], axis=1).astype(float)


def _read_vtu(file):
    """VTK takes a second to load, and CSV files do without. (meshio would be
    quicker, but reads no PVTU files, those of several ranks.)"""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import (vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader)
    reader = (vtkXMLPUnstructuredGridReader if file.suffix == ".pvtu" else
              vtkXMLUnstructuredGridReader)()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    if reader.GetErrorCode() or grid.GetPoints() is None:
        raise NoStates(f"{file} is damaged: VTK cannot read it")
    positions = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    found = {name: positions[:, k] for k, name in enumerate("xyz")}
    time = grid.GetFieldData().GetArray("TIME")
    if time:
        found["time"] = np.full(len(positions), time.GetValue(0))
    data = grid.GetPointData()
    for i in range(data.GetNumberOfArrays()):
        name, values = data.GetArrayName(i), vtk_to_numpy(data.GetArray(i))
        parts = COMPONENTS.get(name, [f"{name}_{axis}" for axis in "xyz"])
        found |= ({name: values} if values.ndim == 1 else dict(zip(parts, values.T)))
    return found


class Run:
    """The output directory of a run. Everything is read on demand and kept, but of cells and
    surface only the state read last. Throws Refused if the directory is none of a run."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.name = self.directory.resolve().name
        for name in ESSENTIAL:
            if not (self.directory / name).is_file():
                raise Refused("The directory", directory, "the output "
                              "directory of a run", f"It has no {name}.")
        self._latest = {}  # kind -> (file, what it holds)

    @cached_property
    def keys(self):
        """All keys as used, as text, by full path ("Grid/Spacing")."""
        return parse((self.directory / "parameters.prm").read_text(encoding="utf-8"))

    def number(self, key):
        """The value of a key that is a number."""
        return float(self.keys[key])

    @property
    def dimension(self):
        """2 or 3."""
        return int(self.keys["Dimension"])

    @cached_property
    def statistics(self):
        """statistics.csv: row 0 for the initial state, then a row a step."""
        file = self.directory / "statistics.csv"
        table = read_csv(file) if file.stat().st_size else ()
        if not len(table):
            raise Refused("The table", file, "a table with the initial state "
                          "and a row a step", "Has the run begun?")
        return _frame(table).rename(columns={"pieces": "connected_tissues"})  # before 0.3.0

    @property
    def digest(self):
        """Tells what was computed from what is there after the next run."""
        return hashlib.sha256((self.directory / "statistics.csv").read_bytes()).hexdigest()

    @property
    def errors(self):
        """What morula accuracy has found of this run, a row a measure: value, error, unit; the
        parts grid, cells, step, position, chance; and `text`, all that in words."""
        import pandas
        file = self.directory / ERRORS
        found = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
        rows = found["errors"] if found.get("of") == self.digest else {}
        return pandas.DataFrame.from_dict({name: {**row, **row["parts"]} for name, row
                                           in rows.items()}, orient="index")

    @cached_property
    def timings(self):
        """timings.csv: calls, wall_seconds, share (of the total) by section;
        empty before the run has ended."""
        import pandas
        file = self.directory / "timings.csv"
        if not file.is_file():
            return pandas.DataFrame(columns=["calls", "wall_seconds", "share"])
        return pandas.read_csv(file, index_col="section")

    @cached_property
    def lineage(self):
        """Every cell that ever lived."""
        file = self.directory / "lineage.csv"
        if not file.is_file():
            raise NoStates(f"{self.directory} has no lineage.csv: it is "
                           "written when the first step ends.")
        return Lineage(_frame(read_csv(file)), self.events)

    @cached_property
    def type_names(self):
        """Names of the cells' types; column `type` has their numbers, from 0.
        None in a scene without types."""
        return names_in(self.keys)

    @cached_property
    def field_names(self):
        """Names of the fields: each is a column of the cells. None in a scene without fields."""
        return names_in(self.keys, "Fields")

    @cached_property
    def events(self):
        """events.csv: every change of a cell's type, its death and its removal, in order of time,
        day: time, id, event ("transition", "death", "removal"), from, to (names of types), and
        cause of a death ("rate", "when") where cells die. Types that daughters get when they are
        born stand in the lineage. Empty in a scene without types or death."""
        return read_events(self.directory / "events.csv", self.type_names)

    @cached_property
    def forces(self):
        """forces.csv: at each output from the first step on a row for each condition, obstacle,
        lumen and force on the cells; forces in kPa um^(dim-1), moments in kPa um^dim. Empty in a
        scene without conditions on the surface."""
        import pandas
        file = self.directory / "forces.csv"
        return pandas.read_csv(file) if file.is_file() else pandas.DataFrame()

    def types_of(self, cell):
        """The types that a cell has had: [(since when, day; name), ...] from
        its birth on; empty in a scene without types."""
        if self.lineage.type is None:
            return []
        self.lineage.require(cell)
        changes = self.events[(self.events["id"] == cell) & (self.events["event"] == "transition")]
        return [(float(self.lineage.birth_time[cell]), self.type_names[self.lineage.type[cell]]),
                *zip(changes["time"], changes["to"])]

    def clone(self, cell):
        """Ids of a cell and all its descendants, dead or alive, in order."""
        return self.lineage.clone(cell)

    @cached_property
    def times(self):
        """When cells and surface were written, days; none with Formats = none."""
        try:
            return np.array([time for time, _ in states(self.directory, "cells")])
        except NoStates:
            return np.array([])

    def cells(self, i):
        """State i of `times` (-1: the last), in order of the ids; lengths in um, stresses in kPa.
        From VTU files columns are single precision (ids and other whole numbers are exact) and
        more: pressure, principal stresses, displacement. Throws NoStates."""
        return self._read("cells", i)

    def surface(self, i):
        """The boundary points of state i, likewise."""
        return self._read("surface", i)

    def at(self, kind, day=None):
        """The state of kind "cells" or "surface" on a day, or the last one."""
        if day is None:
            return self._read(kind, -1)
        times = [time for time, _ in states(self.directory, kind)]
        for i, time in enumerate(times):
            if same_time(time, day):
                return self._read(kind, i)
        raise Refused("The day", day, f"one on which {kind} were written: "
                      + ", ".join(f"{time:g}" for time in times),
                      "Output/Interval says when.")

    def _read(self, kind, i):
        found = states(self.directory, kind)
        if not -len(found) <= i < len(found):
            raise NoStates(f"{self.directory} has no state {i} of the {kind}: "
                           f"there are {len(found)}, from 0 on")
        file = found[i][1]
        if self._latest.get(kind, (None,))[0] != file:
            self._latest[kind] = file, _frame(read_points(file)).sort_values(
                "id", kind="stable", ignore_index=True)
        return self._latest[kind][1]


def _frame(columns):
    import pandas
    frame = pandas.DataFrame(columns)
    return frame.astype({name: np.int64 for name in WHOLE if name in frame
                         and frame[name].dtype.kind != "i"})
