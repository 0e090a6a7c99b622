# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The cells of a state as they are drawn: as spheres, or as polyhedra.

Both have `positions` (n, 3) of the cells, their `columns`, whether they are `flat`, `outermost`
places that a picture must hold, and how far around them (`margin`), and `gaps`, the width below
which ambient occlusion darkens; µm. Their pictures are of the cells of a mask, with a colour
(bytes) each."""
import numpy as np
from morula.run import NoStates, Run, places, read_points
from morula.shapes.regions import regions_of_state

from .points import radii_of

EDGE_WIDTH = 0.04      # in lengths of a cell ...
EDGE_PIXELS = (0.6, 2)  # ... but within these


class Spheres:
    """Of the cells' volumes (2-D: discs), from their file."""

    def __init__(self, file):
        self.columns = read_points(file)
        self.positions = places(self.columns)
        if not len(self.positions):
            raise NoStates(f"{file} has no cells: all have died")
        self.flat = bool(np.ptp(self.positions[:, 2]) == 0 and len(self.positions) > 1)
        self.radii = radii_of(self.columns["volume"], self.flat)
        self.outermost, self.margin = self.positions, self.radii.max()
        self.gaps = 5 * np.median(self.radii)

    def picture(self, colours, kept, view, pixels):
        # VTK needs a screen, which reading the cells does without.
        from . import spheres
        drawn = self.positions[kept], self.radii[kept], colours[kept]
        if self.flat:
            return spheres.render_discs(*drawn, view, pixels)
        return spheres.render(*drawn, view, pixels, self.gaps)


class Shapes:
    """The cells' regions, of state i of a run."""

    def __init__(self, directory, i):
        run = Run(directory)
        cells, regions = run.cells(i), regions_of_state(run, i)
        self.positions, self.bodies = places(cells), regions.bodies
        self.columns = {**{name: cells[name].to_numpy() for name in cells}, **regions.fields}
        self.flat = run.dimension == 2
        self.outermost = self.bodies.points[np.unique(self.bodies.corners)]
        self.margin = 0.0
        self.gaps = np.median(cells["volume"].to_numpy()**(1 / run.dimension))

    def picture(self, colours, kept, view, pixels):
        return self._drawn(self.bodies.select(kept[self.bodies.owner]), colours, view, pixels)

    def section(self, colours, plane, view, pixels):
        """Of all cells behind a plane, which goes through cells."""
        from .shapes import cut_through
        return self._drawn(cut_through(self.bodies, *plane), colours, view, pixels)

    def _drawn(self, bodies, colours, view, pixels):
        from . import shading
        from .shapes import shape_actors
        pixel = view.half_width / pixels[0]  # µm; twice as many are drawn
        width = np.clip(EDGE_WIDTH * self.gaps / pixel, *EDGE_PIXELS)
        return shading.render(shape_actors(bodies, colours, width), view, pixels, self.gaps)
