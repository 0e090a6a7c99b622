# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How large a cell is drawn."""
import numpy as np


def radii_of(volumes, flat=False):
    """Radii (µm) of the spheres, in 2-D of the discs, of these volumes."""
    volumes = np.asarray(volumes, dtype=float)
    return (np.sqrt(volumes / np.pi) if flat else np.cbrt(0.75 * volumes / np.pi))
