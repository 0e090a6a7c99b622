# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""All cells over time as a graph, and a lineage of such a graph.

A node is a cell at a time: at its birth, and in every state that was written. An edge leads from a
cell to itself at the next time, and from the last node of a mother to the first of each daughter.
So cells that no state shows are there, too, and exact times of birth are kept."""
from dataclasses import dataclass, field

import numpy as np

from morula.columns import LENGTH, unit_of
from morula.draw.points import radii_of
from morula.lineage import Lineage
from morula.refusal import Refused
from morula.run import TIME_SLACK

# Columns of the cells that nodes have in another form, or once for all.
OTHERWISE = ("time", "id", "parent", "x", "y", "z", "death_time")


@dataclass
class Property:
    """A number of every node; `missing` (n, bool) where it has none, or None;
    its unit, and what it means."""

    values: np.ndarray
    unit: str = ""
    meaning: str = ""
    missing: np.ndarray = None


@dataclass
class Tracks:
    """Nodes 0, 1, ..., by cell and then by time, with their properties; edges
    (m, 2) from earlier to later nodes. The first node of a cell is its birth."""

    dimension: int
    edges: np.ndarray
    properties: dict
    type_names: tuple = ()
    words: dict = field(default_factory=dict)

    def __len__(self):
        return len(self.properties["cell"].values)

    @property
    def divides_in_two(self):
        """Whether no mother has a single daughter: then a cell is a longest path
        without a branch."""
        return not (np.bincount(self.edges[:, 0], minlength=1)[
            self.edges[self._between, 0]] == 1).any()

    @property
    def _between(self):
        cells = self.properties["cell"].values[self.edges]
        return cells[:, 0] != cells[:, 1]


def tracks_of(run):
    """The graph of a Run. Throws NoStates without a lineage, Refused if cells
    and lineage are not of the same time."""
    lineage = run.lineage
    rows = [{"cell": np.arange(len(lineage)), "t": lineage.birth_time,
             "state": np.full(len(lineage), -1), "row": np.arange(len(lineage))}]
    states = []
    for number, time in enumerate(run.times):
        cells = run.cells(number)
        ids = cells["id"].to_numpy()
        _require_known(ids, lineage, time)
        states.append({name: cells[name].to_numpy() for name in cells})
        rows.append({"cell": ids, "t": np.full(len(ids), time), "state": np.full(len(ids), number),
                     "row": np.arange(len(ids))})
    nodes = {name: np.concatenate([part[name] for part in rows]) for name in rows[0]}
    return _graph(run, lineage, states, *_merged(nodes, lineage))


def _require_known(ids, lineage, time):
    if len(ids) and ids.max() >= len(lineage):
        raise Refused("The run", f"cell {ids.max()} on day {time:g}",
                      f"cells of lineage.csv, 0 to {len(lineage) - 1}",
                      "Has the run been going on meanwhile? Try again.")


def _merged(nodes, lineage):
    """Nodes in their order, and what a birth has of a state of just its time,
    as -1 or the number of that node: one node is enough for both."""
    born = lineage.birth_time[nodes["cell"]]
    slack = TIME_SLACK * np.maximum(1, np.maximum(nodes["t"], born))
    double = (np.abs(nodes["t"] - born) <= slack) & (nodes["state"] >= 0)
    seen = np.full(len(lineage), -1)
    seen[nodes["cell"][double]] = np.flatnonzero(double)
    state, row = nodes["state"].copy(), nodes["row"].copy()
    births = np.flatnonzero(seen >= 0)
    state[births], row[births] = state[seen[births]], row[seen[births]]
    kept = np.flatnonzero(~double)
    order = kept[np.lexsort([nodes["t"][kept], nodes["cell"][kept]])]
    return ({"cell": nodes["cell"][order], "t": nodes["t"][order], "state": state[order],
             "row": row[order]}, nodes["state"][order] < 0)


def _graph(run, lineage, states, nodes, is_birth):
    cell = nodes["cell"]
    first = np.searchsorted(cell, np.arange(len(lineage)))
    last = np.r_[first[1:], len(cell)] - 1
    along = np.flatnonzero(cell[1:] == cell[:-1])
    daughters = np.flatnonzero(lineage.parent >= 0)
    edges = np.concatenate([np.stack([along, along + 1], axis=1),
                            np.stack([last[lineage.parent[daughters]], first[daughters]], axis=1)])
    properties = {
        "cell": Property(cell, "", "id of the cell"),
        "t": Property(nodes["t"], "day", "time"),
        **_places(run, lineage, states, nodes, is_birth),
        "lineage": Property(lineage.founder[cell], "", "id of its founder"),
        "seg_id": Property(cell + 1, "", "label in images of morula export"),
        **_columns(run, lineage, states, nodes, is_birth)}
    for name, times in (("death_time", lineage.death_time), ("removal_time", lineage.removal_time)):
        if np.isfinite(times).any():
            missing = np.isinf(times[cell])
            properties[name] = Property(np.where(missing, 0, times[cell]), "day",
                                        name.replace("_", " of the cell: "),
                                        missing)
    return Tracks(run.dimension, edges, properties, run.type_names, {"run": run.name})


def _of_states(name, states, nodes, values):
    """Puts a column of the states where nodes are of one."""
    for number, columns in enumerate(states):
        mine = nodes["state"] == number
        if name in columns:
            values[mine] = columns[name][nodes["row"][mine]]
    return values


def _places(run, lineage, states, nodes, is_birth):
    """x, y and in 3-D z; of a birth that of the lineage, which has more digits than VTU files."""
    found = {}
    for axis in "zyx"[3 - run.dimension:]:
        values = _of_states(axis, states, nodes, np.zeros(len(is_birth)))
        values[is_birth] = lineage.table[axis].to_numpy()[nodes["cell"][is_birth]]
        found[axis] = Property(values, LENGTH, f"place of the cell, {axis}")
    return found


def _columns(run, lineage, states, nodes, is_birth):
    """The columns of the cells. Births that no state shows have none but
    generation and type, which stand in the lineage."""
    names = list(dict.fromkeys(name for columns in states for name in columns
                               if name not in OTHERWISE))
    nobody = nodes["state"] < 0
    found = {}
    for name in dict.fromkeys(["generation", *names]):
        born = {"generation": lineage.generation, "type": lineage.type}.get(name)
        dtype = np.int64 if born is not None else next(
            columns[name].dtype for columns in states if name in columns)
        values = _of_states(name, states, nodes, np.zeros(len(nobody), dtype))
        if born is not None:
            values[is_birth] = born[nodes["cell"][is_birth]]
        found[name] = Property(values, unit_of(name, run.dimension), "", None if born is not None or
                               not nobody.any() else nobody)
    if lineage.type is not None and "type" not in found:
        found["type"] = Property(lineage.type[nodes["cell"]], "", "")
    if "volume" in found:
        radius = radii_of(found["volume"].values, run.dimension == 2)
        found["radius"] = Property(radius, LENGTH, "of a ball of its volume",
                                   found["volume"].missing)
    return found


def lineage_of(tracks):
    """The Lineage that the graph is of, with its times of death and removal."""
    import pandas
    values = {name: prop.values for name, prop in tracks.properties.items()}
    cell, (source, target) = values["cell"], tracks.edges.T
    ids, first = np.unique(cell, return_index=True)
    parent = np.full(len(ids), -1)
    between = cell[source] != cell[target]
    parent[np.searchsorted(ids, cell[target[between]])] = cell[source[between]]
    zero = np.zeros(len(cell))
    table = {"id": ids, "parent": parent, "generation": values["generation"][first],
             "birth_time": values["t"][first], **{axis: values.get(axis, zero)[first] for axis
                                                  in "xyz"}}
    if "type" in values:
        table["type"] = values["type"][first]
    events = []
    for event in ("death", "removal"):
        prop = tracks.properties.get(f"{event}_time")
        if prop is not None:
            known = first[~prop.missing[first]]
            events.append(pandas.DataFrame({
                "time": prop.values[known], "id": cell[known], "event": event}))
    return Lineage(pandas.DataFrame(table), pandas.concat(events) if events else None)
