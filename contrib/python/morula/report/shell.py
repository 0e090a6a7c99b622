# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Which cells can be seen from outside: the others need not be drawn, as long
as nothing is cut away."""
import numpy as np
from scipy import ndimage

SPACINGS = 1.5  # edge of a voxel, in cells
LAYERS = 3      # voxels that count as the shell


def of(positions, volumes, flat):
    """(in the shell, depth of the shell in um) of cells at positions (n, 3).

    Cells are counted into voxels; the shell is what lies in the outermost
    layers of occupied voxels, also round holes. With three, four to five cells
    thick, a picture of 200,000 cells differs in less than one of a thousand
    pixels from one of all cells. A flat tissue is nothing but shell."""
    edge = SPACINGS * float(np.cbrt(np.mean(volumes)))
    depth = LAYERS * edge
    extent = np.ptp(positions, axis=0)
    # Scattered far apart, cells would need more voxels than is worth while.
    if flat or np.prod(extent / edge + 3) > 50 * len(positions) + 1000:
        return np.ones(len(positions), dtype=bool), depth
    voxel = ((positions - positions.min(axis=0)) / edge).astype(int) + 1
    occupied = np.zeros(voxel.max(axis=0) + 2, dtype=bool)
    occupied[tuple(voxel.T)] = True
    inner = ndimage.binary_erosion(occupied, iterations=LAYERS)
    return ~inner[tuple(voxel.T)], depth
