# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Who looks at the tissue, from where, and where it is cut open."""
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class View:
    """A parallel camera; lengths in µm, unit vectors of the picture's axes."""

    center: np.ndarray
    direction: np.ndarray  # to the viewer, longer than the tissue
    up: np.ndarray
    right: np.ndarray
    half_width: float
    half_height: float

    def pixels(self, width):
        """(width, height) of a picture of even height that it fills."""
        return width, 2 * round(width / 2 * self.half_height / self.half_width)


def view_of(positions, radius=0.0, azimuth=-60.0, elevation=14.0, flat=False):
    """The view, from these angles in degrees, that holds all the positions
    with so much (µm) around each; flat tissue is seen from above."""
    azimuth, elevation = np.radians([azimuth, elevation])
    if flat:
        direction, up = np.array([0., 0, 1]), np.array([0., 1, 0])
    else:
        direction = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation)
                              * np.sin(azimuth), np.sin(elevation)])
        up = np.array([0., 0, 1])
    right = np.cross(up, direction)
    right /= np.linalg.norm(right)
    over = np.cross(direction, right)
    across, along = positions @ right, positions @ over
    margin = 1.06
    half_width = margin * (np.ptp(across) / 2 + radius)
    half_height = margin * (np.ptp(along) / 2 + radius)
    low, high = positions.min(axis=0), positions.max(axis=0)
    center = (low + high) / 2
    center += right * ((across.min() + across.max()) / 2 - center @ right)
    center += over * ((along.min() + along.max()) / 2 - center @ over)
    # Far away, as VTK's ambient occlusion has the background where the viewer is.
    distance = 10 * (np.linalg.norm(high - low) + 2 * radius + 1)
    return View(center, distance * direction, up, right, half_width, half_height)


def cut_plane(positions, azimuth=-60.0, turn=30.0):
    """A point (µm) and the unit normal of the vertical plane through the tissue's middle that
    faces a viewer at this azimuth, but for a turn to the side (degrees)."""
    angle = np.radians(azimuth + turn)
    normal = np.array([np.cos(angle), np.sin(angle), 0])
    depth = positions @ normal
    return normal * (depth.min() + depth.max()) / 2, normal


def behind_cut(positions, azimuth=-60.0, turn=30.0):
    """Which points stay when the tissue is cut open by this plane."""
    origin, normal = cut_plane(positions, azimuth, turn)
    return positions @ normal <= origin @ normal
