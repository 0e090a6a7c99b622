# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pictures of the cells of a 2-D run: flat discs, whose colours are those of the
colour bar, without light and shade."""
import numpy as np

from .spheres import OVER, joined, nearest

RIM = 0.08         # of a disc's radius ...
LEAST_RIM = 0.7    # ... but at least so many pixels
DARKER = 0.62      # a rim is the disc's colour times this


def render(positions, radii, colours, view, pixels):
    """The picture (height, width, 3), colours from 0 to 1, of discs (µm) with a
    colour (bytes) each. Where two overlap, a place is the one's in which it is
    farther inside."""
    width, height = (OVER * n for n in pixels)
    scale = width / (2 * view.half_width)  # pixels of a µm
    over = np.cross(view.direction, view.right)
    over /= np.linalg.norm(over)
    offset = positions - view.center
    places = np.stack([width / 2 + scale * (offset @ view.right),
                       height / 2 - scale * (offset @ over),
                       np.zeros(len(positions))], axis=1).astype(np.float32)
    radii = (scale * np.asarray(radii)).astype(np.float32)
    depth, owner = nearest(places, radii, width, height)
    seen = owner >= 0
    radius = radii[owner[seen]]
    from_centre = np.sqrt(np.maximum(radius**2 - depth[seen]**2, 0))
    rim = np.maximum(RIM * radius, OVER * LEAST_RIM)
    shade = np.where(from_centre > radius - rim, DARKER, 1)
    fine = np.ones((height, width, 3), dtype=np.float32)
    fine[seen] = colours[owner[seen]] / np.float32(255) * shade[:, None]
    return joined(fine)
