# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A run that has been done, as NumPy arrays.

    from morula.run import Run
    run = Run("output/bud")
    run.statistics["total_volume"]      # um^3, an entry a step
    cells = run.cells(-1)               # the last state written
    cells["energy_density"].mean()      # kPa
    run.clone(17)                       # ids of all descendants of cell 17

The columns are those of the files (README.md, "What comes out"). `as_frame`
makes a pandas data frame of any of these tables, if pandas is there.
"""
from functools import cached_property
from pathlib import Path

import numpy as np

from .lineage import Lineage
from .prm import parse
from .refusal import Refused
from .results import read_csv
from .states import NoStates, read_points, states

ESSENTIAL = ("parameters.prm", "statistics.csv")


class Run:
    """The output directory of a run. Everything is read on demand and kept,
    but of cells and surface only the state read last. Throws Refused if the
    directory is none of a run."""

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
        return parse((self.directory / "parameters.prm").read_text(
            encoding="utf-8"))

    def number(self, key):
        return float(self.keys[key])

    @property
    def dimension(self):
        return int(self.keys["Dimension"])

    @cached_property
    def statistics(self):
        """statistics.csv, a structured array: columns by name, a row a step
        and row 0 for the initial state."""
        file = self.directory / "statistics.csv"
        table = read_csv(file) if file.stat().st_size else ()
        if not len(table):
            raise Refused("The table", file, "a table with the initial state "
                          "and a row a step", "Has the run begun?")
        return table

    @cached_property
    def timings(self):
        """timings.csv: section -> (calls, wall seconds, share of the total);
        empty before the run has ended."""
        file = self.directory / "timings.csv"
        if not file.is_file():
            return {}
        return {row["section"]: (int(row["calls"]), float(row["wall_seconds"]),
                                 float(row["share"]))
                for row in read_csv(file, dtype=None)}

    @cached_property
    def lineage(self):
        """Every cell that ever lived."""
        file = self.directory / "lineage.csv"
        if not file.is_file():
            raise NoStates(f"{self.directory} has no lineage.csv: it is "
                           "written when the first step ends.")
        return Lineage(read_csv(file))

    def clone(self, cell):
        """Ids of a cell and all its descendants, dead or alive, in order."""
        return self.lineage.clone(cell)

    @cached_property
    def times(self):
        """When cells and surface were written, days; none with Formats =
        none."""
        try:
            return np.array([time for time, _ in self._states("cells")])
        except NoStates:
            return np.array([])

    def cells(self, i):
        """The columns of state i of `times` (-1: the last) by name, in order
        of the ids; lengths in um, stresses in kPa. From VTU files they are
        single precision (ids and other whole numbers are exact) and more:
        pressure, principal stresses, displacement, and sigma in one piece
        besides. Throws NoStates."""
        return self._read("cells", i)[1]

    def surface(self, i):
        """The boundary points of state i, likewise."""
        return self._read("surface", i)[1]

    def _states(self, kind):
        return states(self.directory, kind)

    def _read(self, kind, i):
        """Positions (n, 3) and columns of state i, in order of the ids."""
        found = self._states(kind)
        if not -len(found) <= i < len(found):
            raise NoStates(f"{self.directory} has no state {i} of the {kind}: "
                           f"there are {len(found)}, from 0 on")
        file = found[i][1]
        if self._latest.get(kind, (None,))[0] != file:
            self._latest[kind] = file, in_order_of_ids(*read_points(file))
        return self._latest[kind][1]


def in_order_of_ids(positions, columns):
    """Whatever was written as a whole number becomes one."""
    order = np.argsort(columns["id"], kind="stable")
    whole = ("id", "parent", "generation", "phase", "condition",
             "held_at_checkpoint")
    return positions[order], {
        name: values[order].astype(np.int64) if name in whole
        else values[order] for name, values in columns.items()}


def as_frame(table):
    """A pandas data frame of statistics, cells, surface or lineage.table;
    columns that are vectors are left out. Throws ImportError without
    pandas."""
    import pandas
    if isinstance(table, dict):
        table = {name: values for name, values in table.items()
                 if np.ndim(values) == 1}
    return pandas.DataFrame(table)
