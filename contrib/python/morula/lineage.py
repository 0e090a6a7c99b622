# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Who descends from whom."""
from functools import cached_property

import numpy as np

from .refusal import Refused


class Lineage:
    """lineage.csv: a row for every cell that ever lived, in order of its id. Ids count from 0;
    those of daughters are larger than their mother's.

    `table` is a data frame with id, parent (-1 for founders), generation, birth_time (days) and x,
    y, z (um) where the cell was born, and in scenes with types the number of the type with which
    it was born; `type` is None in others. `events` are those of the run: its deaths and removals
    are arrays `death_time` and `removal_time` (days; infinity for cells that did not die, or are
    still there)."""

    def __init__(self, table, events=None):
        self.table = table.sort_values("id", kind="stable", ignore_index=True)
        if not np.array_equal(self.table["id"], np.arange(len(self.table))):
            raise Refused("lineage.csv", "its ids", "0, 1, 2, ... without a "
                          "gap", "Is the file whole?")
        self.parent = self.table["parent"].to_numpy()
        self.generation = self.table["generation"].to_numpy()
        self.birth_time = self.table["birth_time"].to_numpy()
        self.type = (self.table["type"].to_numpy() if "type" in self.table else None)

        self.death_time = self._times_of("death", events)
        self.removal_time = self._times_of("removal", events)

    def _times_of(self, event, events):
        times = np.full(len(self), np.inf)
        if events is not None:
            # a run that goes on may have events of cells to come
            rows = events[(events["event"] == event) & (events["id"] < len(self))]
            times[rows["id"]] = rows["time"]
        return times

    def __len__(self):
        return len(self.parent)

    @cached_property
    def founders(self):
        """Number of founders; their ids come first."""
        return int((self.parent < 0).sum())

    @cached_property
    def founder(self):
        """The founder of every cell (n)."""
        found = np.arange(len(self))
        for born in self._generations():
            found[born] = found[self.parent[born]]
        return found

    @cached_property
    def end_time(self):
        """When every cell divided or died, days; infinity for those that have not."""
        end = self.death_time.copy()
        later = self.parent >= 0
        end[self.parent[later]] = self.birth_time[later]
        return end

    @property
    def living(self):
        """Ids of the cells that have neither divided nor died until the end of the run."""
        return np.flatnonzero(np.isinf(self.end_time))

    def clone(self, cell):
        """Ids of a cell and all its descendants, in order."""
        self.require(cell)
        member = np.zeros(len(self), dtype=bool)
        member[cell] = True
        for born in self._generations():
            member[born] |= member[self.parent[born]]
        return np.flatnonzero(member)

    def ancestors(self, cell):
        """Ids from a cell's founder to the cell itself."""
        self.require(cell)
        path = [cell]
        while self.parent[path[-1]] >= 0:
            path.append(int(self.parent[path[-1]]))
        return path[::-1]

    @cached_property
    def clone_sizes(self):
        """Living cells of every founder (founders)."""
        return np.bincount(self.founder[self.living], minlength=self.founders)

    @cached_property
    def clones(self):
        """A data frame, a row a founder: cells that ever lived, and those alive
        at the end of the run."""
        import pandas
        return pandas.DataFrame({"cells": np.bincount(self.founder, minlength=self.founders),
                                 "alive": self.clone_sizes}).rename_axis("founder")

    def tree(self, cell):
        """A cell's descendants as dictionaries of dictionaries: of each daughter
        that of its own daughters."""
        self.require(cell)
        trees = {member: {} for member in self.clone(cell)}
        for member in trees:
            if member != cell:
                trees[self.parent[member]][int(member)] = trees[member]
        return trees[cell]

    def plot(self, cell=0, axes=None, end=None):
        """Draws the tree of a cell with matplotlib: time from left to right, a
        line a cell; `end` (days) is that of the lines of living cells, by default
        the last birth or death. Returns the axes."""
        if axes is None:
            from .style import plt
            axes = plt.figure(layout="constrained").add_subplot()
        if end is None:
            ends = self.end_time[np.isfinite(self.end_time)]
            end = max(self.birth_time.max(), ends.max(initial=0))
        rows = self._rows(cell)
        for member, row in rows.items():
            stop = min(self.end_time[member], end)
            colour = f"C{self.generation[member] % 10}"
            axes.plot([self.birth_time[member], stop], [row, row], colour)
            daughters = [rows[other] for other in rows if self.parent[other] == member]
            if daughters:
                axes.plot([stop, stop], [min(daughters), max(daughters)], colour)
        axes.set(xlabel="time, day", yticks=[], title=f"cell {cell}")
        return axes

    def _rows(self, cell):
        """Rows of a tree's lines: those of cells without daughters follow each
        other, a mother stands in the middle of hers."""
        trees = {member: [] for member in self.clone(cell)}
        for member in list(trees)[1:]:
            trees[self.parent[member]].append(member)
        ends = sorted((member for member, below in trees.items() if not below),
                      key=lambda end: [-member for member in self.ancestors(end)])
        rows = {end: row for row, end in enumerate(ends)}
        for member in reversed(trees):
            if trees[member]:
                rows[member] = np.mean([rows[other] for other in trees[member]])
        return rows

    def _generations(self):
        """Ids of the cells of generation 1, 2, ..."""
        order = np.argsort(self.generation, kind="stable")
        ends = np.cumsum(np.bincount(self.generation))
        return [order[a:b] for a, b in zip(ends, ends[1:])]

    def require(self, cell):
        """Throws Refused for an id that no cell has."""
        if not 0 <= cell < len(self):
            raise Refused("The cell", cell, f"an id from 0 to {len(self) - 1}")
