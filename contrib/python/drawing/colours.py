# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The colours of a field."""
from dataclasses import dataclass

import matplotlib
import matplotlib.cm
import matplotlib.colors
import numpy as np

# How a field is written at the colour bar, and its colour map.
FIELDS = {
    "volume": ("Cell volume [µm³]", "viridis"),
    "generation": ("Generation", "viridis"),
    "phase": ("Phase", "viridis"),
    "energy_density": ("Strain energy density [kPa]", "plasma"),
    "elastic_volume_ratio": ("Elastic volume ratio $J_e$", "cividis"),
    "growth_volume_ratio": ("Growth volume ratio $J_g$", "viridis"),
    "pressure": ("Pressure [kPa]", "cividis"),
    "region_volume": ("Volume of the region [µm³]", "viridis"),
    "neighbours": ("Neighbours", "viridis"),
}
WHOLE_NUMBERS = ("generation", "phase")


@dataclass(frozen=True)
class Colours:
    """A field's label, colour map and limits."""

    label: str
    palette: matplotlib.colors.Colormap
    scale: matplotlib.colors.Normalize
    whole: bool

    def of(self, values):
        """Colours (n, 3), bytes."""
        colours = self.palette(self.scale(np.asarray(values, dtype=float)))
        return (255 * colours[:, :3]).round().astype(np.uint8)

    def draw_bar(self, figure, axes):
        """The colour bar, in axes of its own."""
        bar = figure.colorbar(
            matplotlib.cm.ScalarMappable(self.scale, self.palette), cax=axes)
        bar.outline.set_linewidth(0.6)
        bar.set_label(self.label)
        if self.whole:
            numbers = np.arange(np.ceil(self.scale.vmin),
                                np.floor(self.scale.vmax) + 1)
            bar.set_ticks(numbers,
                          labels=[f"{n:.0f}" for n in abs(numbers)])
            bar.ax.tick_params(which="both", length=0)
        return bar


def colours_of(field, values=None, limits=None):
    """The colours of a field with these limits, by default from the 1st to
    the 99th percentile of the values; whole numbers get a colour each."""
    label, name = FIELDS.get(field, (field, "viridis"))
    # Without the darkest end, in which the shading could not be seen.
    palette = matplotlib.colors.ListedColormap(
        matplotlib.colormaps[name](np.linspace(0.06, 1, 256)))
    whole = field in WHOLE_NUMBERS
    if limits is not None:
        low, high = limits
    elif whole:
        low, high = np.min(values), np.max(values)
    else:
        low, high = np.percentile(values, [1, 99])
    if whole:
        low, high = low - 0.5, high + 0.5
        palette = palette.resampled(int(high - low))
    elif high - low < 1e-6 * abs(high):
        low, high = low - 0.5 * abs(low or 1), high + 0.5 * abs(high or 1)
    scale = matplotlib.colors.Normalize(low, high, clip=True)
    return Colours(label, palette, scale, whole)
