# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The panels of the paper's figures and the scenes that each of them needs."""

GRIDS = ("fig-2a", "fig-2b", "fig-2c", "fig-2d", "fig-2e")
# The size checkpoint's J_th: none, 0.7, 0.8, 0.9, 0.95.
CHECKPOINTS = ("fig-4c", "fig-4e-0.7", "fig-4e-0.8", "fig-4b", "fig-4e-0.95")

# Panel: (scenes in prm/paper, what it shows).
PANELS = {
    "fig-1d": (("fig-1d",), "a cube whose cells all divide at once"),
    **{scene: ((scene,), f"half-fixed sphere, isotropic growth, h = {h} µm")
       for scene, h in zip(GRIDS, (33, 50, 75, 100, 25))},
    "fig-2f": (GRIDS, "outlines of the five"),
    "fig-2g": (GRIDS, "outlines magnified at the clamp's edge"),
    "fig-3a": (("fig-3a",), "a cube grows isotropically: cell volumes"),
    "fig-3b": (("fig-3b",), "a cube proliferates: generation, volume, energy"),
    "fig-3c": (("fig-3b",), "its number of cells over time"),
    "fig-3d": (("fig-3b",), "its total volume over time"),
    "fig-3e": (("fig-3b",), "its mean energy density over time"),
    "fig-4a": (("fig-4c",), "half-fixed sphere without checkpoint: volumes"),
    "fig-4b": (("fig-4b",), "with checkpoint: generation, energy, shape"),
    "fig-4c": (("fig-4c",), "without checkpoint: generation, energy, shape"),
    "fig-4d": (("fig-4d",), "isotropic growth: energy, shape"),
    "fig-4e": (CHECKPOINTS, "cells over time for five checkpoints"),
    "fig-4f": (CHECKPOINTS, "total volume over cells for five checkpoints"),
    "fig-4g": (CHECKPOINTS, "mean energy over cells for five checkpoints"),
    "video-1": (("fig-3b",), "Fig. 3 (b) in time"),
    "video-2": (("fig-4b",), "Fig. 4 (b) in time"),
    "video-3": (("fig-4c",), "Fig. 4 (c) in time"),
}

# Whole figures: rows of panels.
FIGURES = {
    "fig-2": (GRIDS, ("fig-2f", "fig-2g")),
    "fig-3": (("fig-3a",), ("fig-3b",), ("fig-3c", "fig-3d", "fig-3e")),
    "fig-4": (("fig-4a",), ("fig-4b", "fig-4c", "fig-4d"), ("fig-4e", "fig-4f", "fig-4g")),
}

# The scenes that take longest begin first, so that the last one does not run alone.
LONGEST = ("fig-4c", "fig-2e", "fig-4e-0.7", "fig-4b", "fig-4e-0.8", "fig-4e-0.95")


def select(names):
    """The panels of these names in the paper's order; no name stands for all. Throws LookupError
    with a name that is neither a panel nor the beginning of one."""
    chosen = set()
    for name in names:
        found = [panel for panel in PANELS if panel == name or
                 name in (panel[:-1], panel.rpartition("-")[0] + "s")]
        if not found:
            raise LookupError(name)
        chosen.update(found)
    return [panel for panel in PANELS if panel in chosen or not names]


def scenes_of(panels):
    """The scenes that the panels need, the longest first."""
    needed = dict.fromkeys(scene for panel in panels for scene in PANELS[panel][0])
    return sorted(needed, key=lambda scene: (*LONGEST, scene).index(scene))


def listing():
    """All panels with what they show, a line each."""
    return "\n".join(f"  {panel:<9}{text}" for panel, (_, text) in PANELS.items())
