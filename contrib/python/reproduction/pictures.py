# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Shaded pictures of a run's states."""
from dataclasses import dataclass, replace

import numpy as np
from morula.draw import shading, spheres
from morula.draw.colours import colours_of
from morula.draw.points import radii_of
from morula.draw.surface import triangles_of
from morula.draw.view import View, behind_cut, view_of

FREE_SURFACE = (214, 170, 148)  # red, green, blue
HELD_SURFACE = (150, 152, 160)


def common_view(runs_and_times, at_least=(0.0, 0.0)):
    """The view that holds the tissue of all these runs and times, and at least
    so much to the sides and up and down of its centre (µm): panels that are
    compared have the same scale."""
    positions = [run.read("surface", time)[0] for run, time in runs_and_times]
    view = view_of(np.vstack(positions), radius=8.0)
    return replace(view, half_width=max(view.half_width, at_least[0]),
                   half_height=max(view.half_height, at_least[1]))


@dataclass(frozen=True)
class Camera:
    """A view and the width of its pictures in pixels."""

    view: View
    width: int

    @property
    def pixels(self):
        return self.view.pixels(self.width)

    @property
    def micrometres_per_pixel(self):
        return 2 * self.view.half_width / self.width

    def cells(self, run, time, field, limits=None, cut=False):
        """Cells as spheres of their volume, coloured by a field; cut: the
        half behind a plane through the middle. The picture and its colours."""
        positions, columns = run.read("cells", time)
        colours = colours_of(field, columns[field], limits)
        kept = (behind_cut(positions, turn=0) if cut else
                np.ones(len(positions), dtype=bool))
        radii = radii_of(columns["volume"])
        image = spheres.render(positions[kept], radii[kept],
                               colours.of(columns[field][kept]), self.view,
                               self.pixels, 5 * float(np.median(radii)))
        return image, colours

    def surface(self, run, time):
        """The outer shape; what is held or slides is grey."""
        positions, columns = run.read("surface", time)
        initial = np.stack([columns[name] for name in "XYZ"], axis=1)
        held = (columns["condition"] == 1) | (columns["condition"] == 2)
        colours = np.where(held[:, None], np.uint8(HELD_SURFACE),
                           np.uint8(FREE_SURFACE)).astype(np.uint8)
        actor = shading.surface_actor(positions, triangles_of(initial),
                                      colours)
        return shading.render([actor], self.view, self.pixels)
