# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Panels with their title, scale bar and colour bar as one picture."""
import numpy as np
from morula.style import pixels, plt
from scipy.ndimage import gaussian_filter

DPI = 200
TOP, BOTTOM, SIDE = 0.42, 0.5, 1.25  # inches around the panels
OUTLINE = "0.2"
BESIDE_NAMES = 0.75  # inches of colour bar and label, without its names


def round_length(length):
    """The largest of 1, 2, 5 times a power of ten below the length."""
    power = 10.0**np.floor(np.log10(length))
    return max(f * power for f in (1, 2, 5) if f * power <= length)


def compose(panels, cut_open, view, colours, title, outline=None):
    """The picture (height, width, 3), bytes. `outline` is that of the cut, 1 within and 0 outside
    (height, width); without it, a cut-open panel gets the outline of what it shows."""
    height, width = panels[0].shape[:2]
    wide = width / DPI
    side = max(SIDE, BESIDE_NAMES + colours.longest_name)
    total = (len(panels) * wide + side, height / DPI + TOP + BOTTOM)
    with plt.rc_context({"font.family": "sans-serif", "font.size": 10}):
        figure = plt.figure(figsize=total, dpi=DPI, facecolor="white")
        for i, panel in enumerate(panels):
            axes = figure.add_axes([i * wide / total[0], BOTTOM / total[1], wide / total[0], height
                                    / DPI / total[1]])
            axes.imshow(panel, interpolation="nearest")
            if cut_open[i]:
                axes.contour(silhouette(panel) if outline is None else outline,
                             levels=[0.5], colors=OUTLINE, linewidths=0.9)
            axes.set_axis_off()
        draw_scale(figure, view, width, height, total)
        figure.text(0.04 * wide / total[0], 1 - 0.12 / total[1], title,
                    ha="left", va="top", fontsize=11, parse_math=False)
        bar = figure.add_axes([(len(panels) * wide + 0.15) / total[0], 0.2, 0.14 / total[0], 0.6])
        colours.draw_bar(figure, bar)
        return pixels(figure)


def silhouette(panel):
    """Where something is drawn, smoothed over the gaps between cells."""
    return gaussian_filter((panel.min(axis=2) < 1).astype(float), 6)


def draw_scale(figure, view, width, height, total):
    unit = 2 * view.half_height / height  # µm per pixel
    length = round_length(0.3 * 2 * view.half_width)
    axes = figure.add_axes([0, 0, width / DPI / total[0], BOTTOM / total[1]])
    axes.set_axis_off()
    axes.set(xlim=(0, width), ylim=(0, 1))
    axes.plot([0.04 * width, 0.04 * width + length / unit], [0.45, 0.45],
              color="black", linewidth=2, solid_capstyle="butt")
    axes.text(0.05 * width + length / unit, 0.43, f"{length:g} µm", ha="left", va="center")
