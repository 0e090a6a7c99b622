# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The pictures of the states asked for. All of them have one view, which holds
the tissue at all these times, and one meaning of the colours."""
import numpy as np
from morula.draw import tissue
from morula.draw.colours import colours_of
from morula.draw.outline import inside_of_cut
from morula.draw.view import behind_cut, cut_plane, view_of
from morula.refusal import Refused
from morula.run import NoStates, places, read_points, states

from .composition import compose


class Frames:
    """Reads every state twice, as long films would not fit into memory."""

    def __init__(self, request):
        self.request, self.options = request, request.options
        corners, values = [], []
        for state in request.states:
            cells = self._cells(state)
            self._require_field(cells, state)
            outermost = cells.outermost
            corners += [outermost.min(axis=0) - cells.margin, outermost.max(axis=0) + cells.margin]
            values.append(np.asarray(cells.columns[self.options.field]))
            self.flat = cells.flat
        self.colours = colours_of(self.options.field, np.concatenate(values), request.limits,
                                  request.types).in_dimension(2 if self.flat else 3)
        angles = self.options.azimuth, self.options.elevation
        if len(request.states) == 1:
            self.view = view_of(outermost, cells.margin, *angles, cells.flat)
        else:
            low, high = np.min(corners, axis=0), np.max(corners, axis=0)
            box = np.array(np.meshgrid(*zip(low, high))).reshape(3, -1).T
            self.view = view_of(box, 0.0, *angles, self.flat)
        self.pixels = self.view.pixels(self.options.width)

    def __iter__(self):
        """(number of the state, picture) one after the other."""
        for state in self.request.states:
            yield state[0], self._picture(state)

    def _cells(self, state):
        number, _, file = state
        return (tissue.Shapes(self.options.directory, number)
                if self.options.shapes else tissue.Spheres(file))

    def _require_field(self, cells, state):
        there = sorted(name for name, values in cells.columns.items() if np.ndim(values) == 1)
        if self.options.field not in there:
            raise Refused("--field", self.options.field,
                          f"a column of {state[2].name}: " + ", ".join(there))

    def _picture(self, state):
        cells = self._cells(state)
        title = self.options.title
        if title is None:
            title = f"{state[1]:g} d,  {len(cells.positions):,} cells"
        cut_open = [False] if self.flat else self.request.cut_open
        colours = self.colours.of(cells.columns[self.options.field])
        panels = [self._panel(cells, colours, cut) for cut in cut_open]
        return compose(panels, cut_open, self.view, self.colours, title,
                       self._outline(cells, state) if True in cut_open else None)

    def _panel(self, cells, colours, cut):
        """Of all cells, or cut open."""
        camera = self.view, self.pixels
        if cut and self.options.section:
            plane = cut_plane(cells.positions, self.options.azimuth)
            return cells.section(colours, plane, *camera)
        kept = (behind_cut(cells.positions, self.options.azimuth) if cut
                else np.ones(len(colours), dtype=bool))
        return cells.picture(colours, kept, *camera)

    def _outline(self, cells, state):
        """That of the cut, or None for tissue without boundary points."""
        try:
            surface = read_points(states(self.options.directory, "surface")[state[0]][1])
        except (NoStates, IndexError):
            return None
        return inside_of_cut(
            cells.positions, np.cbrt(np.median(cells.columns["volume"])),
            (places(surface), np.stack([surface[axis] for axis in
                                        ("nx", "ny", "nz")], axis=1)),
            cut_plane(cells.positions, self.options.azimuth), self.view,
            self.pixels,
            (cells.columns["body"], surface["body"]) if "body" in surface
            else None)
