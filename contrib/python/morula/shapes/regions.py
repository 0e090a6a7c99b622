# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The regions of all cells of a state, and what is measured of them."""
from dataclasses import dataclass, replace

import numpy as np
from morula.refusal import Refused
from morula.run import NoStates, places, time_of

from .boundary import OUTSIDE, Boundary, cut_at_surface
from .polyhedra import SURFACE, Polyhedra, joined
from .voronoi import voronoi_regions

# A wall smaller than this part of the square of a cell's length (2-D: of the
# length) makes no neighbours: in a lattice, rounding opens such walls between
# cells that meet at an edge.
LEAST_WALL = 1e-3


@dataclass(frozen=True)
class Regions:
    """One polyhedron a cell, in the order of the cells, and of each its volume
    (um^3; 2-D: of a prism 1 um thick, which is its area in um^2), its number
    of neighbours, and whether it touches the surface."""

    bodies: Polyhedra
    volume: np.ndarray
    neighbours: np.ndarray
    touches_surface: np.ndarray

    @property
    def fields(self):
        """As columns besides those of the cells."""
        return {"region_volume": self.volume, "neighbours": self.neighbours,
                "touches_surface": self.touches_surface.astype(np.int32)}


def regions_of(positions, volumes, boundary, flat):
    """The regions of cells at positions (n, 3) with these volumes, both in um,
    inside a Boundary. Throws Refused if two cells are at the same place."""
    centres = positions.astype(float)
    lengths = np.asarray(volumes, dtype=float)**(1 / (2 if flat else 3))
    bodies = voronoi_regions(centres, lengths.max(), flat)
    require_all(bodies, centres)
    at_surface = reaching_out(bodies, boundary, lengths)
    cells = np.flatnonzero(at_surface)
    number = np.cumsum(at_surface) - 1
    outer = at_surface[bodies.owner]
    inner, outer = bodies.select(~outer), bodies.select(outer)
    outer = replace(outer, owner=number[outer.owner])
    outer = cut_at_surface(outer, boundary, centres[cells], lengths[cells], volumes[cells])
    outer = replace(outer, owner=cells[outer.owner])
    bodies = joined([inner, outer])
    return measured(bodies.select(np.argsort(bodies.owner, kind="stable")), centres, flat)


def require_all(bodies, positions):
    """Throws Refused for cells without a region."""
    missing = np.bincount(bodies.owner, minlength=len(positions)) == 0
    if missing.any():
        place = positions[missing.argmax()]
        raise Refused("The cells", f"{len(positions)} cells", "cells at different places",
                      f"Several are at ({place[0]:g}, {place[1]:g}, {place[2]:g}) um.")


def reaching_out(bodies, boundary, lengths):
    """Which cells have regions with corners outside of the surface."""
    used = np.unique(bodies.corners)
    outside = np.zeros(len(bodies.points), dtype=bool)
    outside[used] = boundary.outside(bodies.points[used], OUTSIDE * lengths.min())
    result = np.zeros(len(lengths), dtype=bool)
    result[np.repeat(bodies.owner, bodies.counts)[outside[bodies.corners]]] = (True)
    return result


def measured(bodies, centres, flat):
    """With volumes, neighbours and whether they touch the surface."""
    number = len(centres)
    volume = bodies.volumes(centres)
    # In 2-D an area, of a wall 1 um high, is a length.
    area = np.linalg.norm(bodies.area_vectors(), axis=1)
    least = LEAST_WALL * (np.sqrt(volume) if flat else volume**(2 / 3))
    outer = bodies.beyond == SURFACE
    surface_area = np.bincount(bodies.owner[outer], area[outer], number)
    pairs = neighbour_pairs(bodies, area, least)
    return Regions(bodies, volume, np.bincount(pairs.ravel(), minlength=number), surface_area
                   > least)


def neighbour_pairs(bodies, area, least):
    """Pairs (n, 2) of cells with a wall between them that is at least so large
    (um^2) for one of the two. The planes that cut one of them can leave less of
    it than those of the other: then the smaller wall counts."""
    number = len(least)
    inner = bodies.beyond >= 0
    one, other, area = bodies.owner[inner], bodies.beyond[inner], area[inner]
    key = np.minimum(one, other) * number + np.maximum(one, other)
    order = np.argsort(key, kind="stable")
    key, area = key[order], area[order]
    both = np.flatnonzero(key[1:] == key[:-1])
    smaller = np.minimum(area[both], area[both + 1])
    pairs = np.stack(np.divmod(key[both], number), axis=1)
    return pairs[smaller > least[pairs].min(axis=1)]


def regions_of_state(run, i):
    """The regions of the cells of state i of a Run. Throws Refused for tissue
    without boundary points."""
    cells = run.cells(i)
    try:
        surface = run.surface(i)
    except NoStates:
        files = [*run.directory.glob("surface-[0-9]*.csv")]
        if not files or any(time_of(file) is not None for file in files):
            raise
        surface = ()  # files with the names of columns alone
    if not len(surface):
        raise Refused("The run", run.directory, "tissue with boundary points",
                      "Regions of cells are cut off at its surface, and there is "
                      "none: Tissue/Points surface = always makes one.")
    normals = surface[["nx", "ny", "nz"]].to_numpy(dtype=float)
    return regions_of(places(cells), cells["volume"].to_numpy(),
                      Boundary(places(surface), normals), run.dimension == 2)
