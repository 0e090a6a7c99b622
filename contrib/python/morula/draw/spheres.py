# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pictures of cells as spheres and, in 2-D, as flat discs."""
import numpy as np
from scipy.spatial import cKDTree
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

from . import shading

RIM = 0.08     # of a disc's radius ...
LEAST_RIM = 0.7  # ... but at least so many pixels
COARSER = 2   # a picture of numbers has so many pixels less, per direction
BESIDE = 1.5  # radii from the centre of a sphere that is seen to that of a neighbour
DARKER = 0.62  # a rim is the disc's colour times this


def render(positions, radii, colours, view, pixels, gaps):
    """The picture (height, width, 3), colours from 0 to 1, of spheres (µm)
    with a colour (bytes) each; gaps narrower than so many µm become dark."""
    kept = not_buried(positions, radii, view, pixels)
    return shading.render([sphere_actor(positions[kept], radii[kept], colours[kept])], view,
                          pixels, gaps)


def not_buried(positions, radii, view, pixels):
    """A mask of the spheres that a small picture shows, in which each has its number as its
    colour, and of their neighbours, of which it may miss some. VTK shades all of every
    sphere, what others hide as well: without a graphics card that takes most of the time."""
    numbers = np.arange(len(radii))[:, None] >> np.array([0, 8, 16]) & 255
    image = shading.drawn([shading.unlit(sphere_actor(positions, radii, numbers.astype(np.uint8)))],
                          view, [max(1, n // COARSER) for n in pixels])
    found = np.unique(image.astype(int) @ [1, 1 << 8, 1 << 16])
    seen = found[found < len(radii)]  # the background has the number of white
    if not len(seen):
        return np.ones(len(radii), dtype=bool)
    return cKDTree(positions[seen]).query(positions)[0] < BESIDE * radii


def sphere_actor(positions, radii, colours):
    data = shading.poly_data(positions.astype(np.float32), colours)
    data.SetVerts(shading.cell_array(np.arange(len(radii))[:, None]))
    array = numpy_to_vtk(np.asarray(radii, dtype=np.float32), deep=True)
    array.SetName("radius")
    data.GetPointData().AddArray(array)
    mapper = vtkOpenGLSphereMapper()
    mapper.SetInputData(data)
    mapper.SetScaleArray("radius")
    return shading.shaded_actor(mapper)


def render_discs(positions, radii, colours, view, pixels):
    """The same of discs, whose colours are those of the colour bar, without light and shade. Where
    two overlap, a place is the one's in which it is farther inside: they are spheres seen from
    above. A second one in each, of the disc without its rim, stands out of the first everywhere."""
    rim = np.maximum(RIM * radii, LEAST_RIM * 2 * view.half_width / pixels[0])
    inner = np.maximum(radii - rim, 0)
    lift = np.sqrt(radii**2 - inner**2)[:, None] * np.array([0, 0, 1])
    actors = [sphere_actor(positions, radii, (DARKER * colours).astype(np.uint8)),
              sphere_actor(positions + lift, inner, colours)]
    return shading.render(list(map(shading.unlit, actors)), view, pixels)
