# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The colours of a field."""
from dataclasses import dataclass, replace
from dataclasses import field as of_each

import matplotlib
import matplotlib.cm
import matplotlib.colors
import numpy as np
from matplotlib.textpath import TextPath

# How a field is written at the colour bar, and its colour map.
FIELDS = {
    "volume": ("Cell volume [µm³]", "viridis"),
    "generation": ("Generation", "viridis"),
    "phase": ("Phase", "phase"),
    "type": ("Type", "type"),
    "held_at_checkpoint": ("At the size checkpoint", "held_at_checkpoint"),
    "energy_density": ("Strain energy density [kPa]", "plasma"),
    "elastic_volume_ratio": ("Elastic volume ratio $J_e$", "cividis"),
    "growth_volume_ratio": ("Growth volume ratio $J_g$", "viridis"),
    "pressure": ("Pressure [kPa]", "coolwarm"),
    "region_volume": ("Volume of the region [µm³]", "viridis"),
    "neighbours": ("Neighbours", "viridis"),
}
WHOLE_NUMBERS = ("generation", "phase", "type", "held_at_checkpoint")
# Numbers that stand for something: its name and its colour, the same in every
# picture. People who see few colours can tell them apart (Okabe & Ito 2008).
NAMED = {
    "phase": {0: ("G0", "#56B4E9"), 1: ("S", "#009E73"),
              2: ("G2", "#F0E442"), 3: ("M", "#D55E00"),
              4: ("G1", "#0072B2"), 9: ("no cycle", "#B8BBC0")},
    "held_at_checkpoint": {0: ("not waiting", "#B8BBC0"),
                           1: ("waiting", "#D55E00")}}
# Of cell types by their numbers, from the same source; more types than that
# get them again, darker.
OF_TYPES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442", "#B8BBC0")
DARKER = 0.55
DIVERGING = "coolwarm"


def meanings(field, types=(), values=()):
    """What the numbers of a field stand for, {number: (name, colour)}; nothing
    for most fields. `types` are the names of cell types; a type among the
    values that has none is called by its number."""
    if field != "type":
        return NAMED.get(field, {})
    n = max(len(types), int(np.max(values, initial=-1)) + 1)
    names = [*types, *map(str, range(len(types), n))]
    return {i: (name, colour_of_type(i)) for i, name in enumerate(names)}


def colour_of_type(number):
    again, place = divmod(number, len(OF_TYPES))
    colour = matplotlib.colors.to_rgb(OF_TYPES[place])
    return matplotlib.colors.to_hex(np.multiply(colour, DARKER if again else 1))


def around_zero(field):
    """Whether a field has two sides: pressed and pulled."""
    return field == "pressure" or field.startswith(("sigma_", "principal_"))


def style_of(field):
    """(label, colour map's name) of any field; a name from elsewhere is no
    formula, whatever dollars stand in it."""
    plain = field.replace("$", r"\$")
    if around_zero(field):
        return FIELDS.get(field, (f"{plain} [kPa]", DIVERGING))
    return FIELDS.get(field, (plain, "viridis"))


def palette_of(name):
    """Without the darkest end, in which the shading could not be seen; maps
    with a middle have none."""
    ends = (0, 1) if name == DIVERGING else (0.06, 1)
    return matplotlib.colors.ListedColormap(matplotlib.colormaps[name](np.linspace(*ends, 256)))


def limits_of(field, values, percentiles=(1, 99)):
    """The ends of the colours: of whole numbers all, else these percentiles,
    as far on the one side of 0 as on the other where a field has two."""
    if field in WHOLE_NUMBERS:
        return float(np.min(values)), float(np.max(values))
    low, high = map(float, np.percentile(values, percentiles))
    if around_zero(field):
        high = max(abs(low), abs(high))
        low = -high
    if high - low < 1e-6 * max(abs(low), abs(high)) or high == low:
        middle = abs(low) or 1.0
        low, high = low - 0.5 * middle, high + 0.5 * middle
    return low, high


@dataclass(frozen=True)
class Colours:
    """A field's label, colour map and limits; which ends (neither, min, max,
    both) stand for all beyond them, too; names of whole numbers."""

    label: str
    palette: matplotlib.colors.Colormap
    scale: matplotlib.colors.Normalize
    whole: bool
    extend: str = "neither"
    names: dict = of_each(default_factory=dict)

    def of(self, values):
        """Colours (n, 3), bytes."""
        colours = self.palette(self.scale(np.asarray(values, dtype=float)))
        return (255 * colours[:, :3]).round().astype(np.uint8)

    def in_dimension(self, dimension):
        """The same in 2-D, where a volume is an area."""
        return self if dimension == 3 else replace(self, label=self.label.replace("µm³", "µm²"))

    def _written(self):
        """The names, none of which is a formula."""
        return [name.replace("$", r"\$") for name in self.names.values()]

    @property
    def longest_name(self):
        """Inches that it takes at the colour bar; 0 without names."""
        return max((TextPath((0, 0), name, size=10).get_extents().width / 72
                    for name in self._written()), default=0.0)

    def draw_bar(self, figure, axes):
        """The colour bar, in axes of its own; an arrow at an end that stands
        for all beyond it, too."""
        bar = figure.colorbar(matplotlib.cm.ScalarMappable(self.scale, self.palette), cax=axes,
                              extend=self.extend)
        bar.outline.set_linewidth(0.6)
        bar.set_label(self.label)
        if self.names:
            edges = self.scale.boundaries
            bar.set_ticks((edges[1:] + edges[:-1]) / 2, labels=self._written())
        elif self.whole:
            numbers = np.arange(np.ceil(self.scale.vmin), np.floor(self.scale.vmax) + 1)
            bar.set_ticks(numbers, labels=[f"{n:.0f}" for n in abs(numbers)])
        if self.whole:
            bar.ax.tick_params(which="both", length=0)
        return bar


def colours_of(field, values=None, limits=None, types=()):
    """The colours of a field with these limits, by default from the 1st to the 99th percentile of
    the values; whole numbers get a colour each. `types` are the names of cell types."""
    known = meanings(field, types, () if values is None else values)
    if known:
        return named(field, known)
    label, name = style_of(field)
    palette, whole = palette_of(name), field in WHOLE_NUMBERS
    low, high = limits_of(field, values) if limits is None else limits
    extend = "neither" if values is None else ("neither", "min", "max", "both")[
        int(np.min(values) < low) + 2 * int(np.max(values) > high)]
    if whole:
        low, high = low - 0.5, high + 0.5
        palette = palette.resampled(int(high - low))
    scale = matplotlib.colors.Normalize(low, high, clip=True)
    return Colours(label, palette, scale, whole, extend)


def named(field, known):
    numbers = np.array(sorted(known), dtype=float)
    edges = np.concatenate([[numbers[0] - 0.5],
                            (numbers[1:] + numbers[:-1]) / 2,
                            [numbers[-1] + 0.5]])
    names, colours = zip(*(known[int(n)] for n in numbers))
    return Colours(style_of(field)[0], matplotlib.colors.ListedColormap(colours),
                   matplotlib.colors.BoundaryNorm(edges, len(numbers)), True,
                   names=dict(zip(numbers, names)))
