# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Shaded pictures of a run's states, each with its colours (None: of no field)."""
from dataclasses import dataclass, replace

import numpy as np
from morula.draw import shading
from morula.draw.colours import colours_of
from morula.draw.surface import triangles_of
from morula.draw.tissue import Spheres
from morula.draw.view import View, behind_cut, view_of
from morula.run import places, states

FREE_SURFACE = (214, 170, 148)  # red, green, blue
HELD_SURFACE = (150, 152, 160)


@dataclass(frozen=True)
class Camera:
    """A view and the width of its pictures in pixels."""

    view: View
    width: int

    @classmethod
    def of(cls, run, state, width, at_least=(0.0, 0.0)):
        """Holds the tissue of a state, and at least so much to the sides and up and
        down of its centre (µm): panels that are compared have the same scale."""
        view = view_of(places(run.surface(state)), radius=8.0)
        return cls(replace(view, half_width=max(view.half_width, at_least[0]),
                           half_height=max(view.half_height, at_least[1])), width)

    @property
    def extent(self):
        """Left, right, bottom, top of a picture, µm."""
        view = self.view
        return -view.half_width, view.half_width, -view.half_height, view.half_height

    def cells(self, run, state, field, limits=None, cut=False):
        """Cells as spheres of their volume, coloured by a field; cut: the half behind a
        plane through the middle."""
        cells = Spheres(states(run.directory, "cells")[state][1])
        values = cells.columns[field]
        colours = colours_of(field, values, limits)
        kept = (behind_cut(cells.positions, turn=0) if cut else np.ones(len(values), dtype=bool))
        return cells.picture(colours.of(values), kept, self.view,
                             self.view.pixels(self.width)), colours

    def surface(self, run, state):
        """The outer shape; what is held or slides is grey."""
        surface = run.surface(state)
        held = surface["condition"].isin([1, 2]).to_numpy()
        colours = np.where(held[:, None], np.uint8(HELD_SURFACE), np.uint8(FREE_SURFACE))
        triangles = triangles_of(surface[["X", "Y", "Z"]].to_numpy(float))
        actor = shading.surface_actor(places(surface), triangles, colours)
        return shading.render([actor], self.view, self.view.pixels(self.width)), None
