# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How panels are laid out: grids of pictures, curves, whole figures."""
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from morula.draw.colours import Colours
from PIL import Image

DPI = 150
STYLE = {"font.family": "sans-serif", "font.size": 9, "axes.linewidth": 0.7,
         "axes.spines.top": False, "axes.spines.right": False,
         "legend.frameon": False, "legend.fontsize": 8,
         "lines.linewidth": 1.6, "savefig.facecolor": "white"}


@dataclass(frozen=True)
class Row:
    """Pictures side by side with a label and, maybe, a colour bar."""

    label: str
    images: list
    colours: Colours = None


def letter(figure, text):
    """The panel's letter, top left."""
    figure.text(0.04 / figure.get_figwidth(),
                1 - 0.05 / figure.get_figheight(), text, ha="left", va="top",
                fontsize=13, fontweight="bold")


def save(figure, path):
    figure.savefig(path, dpi=DPI)
    plt.close(figure)


def picture_grid(path, name, rows, titles, micrometres_per_pixel, bar_length):
    """Rows of equally large pictures below titles, a scale bar (µm) at the
    bottom, colour bars at the right; measures in inches."""
    height, width = (n / DPI for n in rows[0].images[0].shape[:2])
    gap, top, bottom = 0.06, 0.48, 0.36
    left = 0.34 if any(row.label for row in rows) else 0.1
    right = 0.95 if any(row.colours for row in rows) else 0.1
    columns = len(titles)
    total = (left + columns * (width + gap) + right,
             top + len(rows) * (height + gap) + bottom)
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=total)

        def axes_at(x, y, w, h):
            return figure.add_axes([x / total[0], y / total[1], w / total[0],
                                    h / total[1]])

        for i, row in enumerate(rows):
            low = bottom + (len(rows) - 1 - i) * (height + gap)
            for k, image in enumerate(row.images):
                axes = axes_at(left + k * (width + gap), low, width, height)
                axes.imshow(image, interpolation="nearest")
                axes.set_axis_off()
            figure.text(0.2 / total[0], (low + height / 2) / total[1],
                        row.label, rotation=90, ha="center", va="center")
            if row.colours:
                bar = axes_at(total[0] - right + 0.08, low + 0.1 * height,
                              0.1, 0.8 * height)
                row.colours.draw_bar(figure, bar)
                bar.yaxis.label.set_size(8)
                bar.tick_params(labelsize=7.5)
        for k, title in enumerate(titles):
            figure.text((left + k * (width + gap) + width / 2) / total[0],
                        1 - (top - 0.06) / total[1], title, ha="center",
                        va="bottom")
        draw_scale_bar(figure, left, total, bar_length,
                       bar_length / micrometres_per_pixel / DPI)
        letter(figure, name)
        save(figure, path)


def draw_scale_bar(figure, left, total, length, inches):
    x = np.array([left + 0.05, left + 0.05 + inches]) / total[0]
    y = 0.16 / total[1]
    figure.add_artist(plt.Line2D(x, [y, y], color="black", linewidth=2,
                                 solid_capstyle="butt"))
    figure.text(x[1] + 0.06 / total[0], y, f"{length:g} µm", ha="left",
                va="center", fontsize=8)


def curves(path, name, draw, plot=(2.6, 2.1), right=0.2, bottom=0.5):
    """A panel of curves that draw(axes) fills; the size of the plot itself,
    of the room at its right, and below it are in inches."""
    left, top = 0.66, 0.34
    size = (left + plot[0] + right, bottom + plot[1] + top)
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=size)
        axes = figure.add_axes([left / size[0], bottom / size[1],
                                plot[0] / size[0], plot[1] / size[1]])
        draw(axes)
        letter(figure, name)
        save(figure, path)


def scientific(axes, which, power, unit=""):
    """Ticks of an axis in units of 10^power, named in its label."""
    axis = getattr(axes, f"{which}axis")
    axis.set_major_formatter(lambda value, _: f"{value / 10**power:g}")
    digits = str(power).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    label = f"10{digits} {unit}".strip()
    axis.set_label_text(f"{axis.get_label_text()} [{label}]")


def whole_figure(path, rows):
    """Panels that were drawn already, pasted together row by row."""
    pictures = [[Image.open(panel).convert("RGB") for panel in row]
                for row in rows]
    heights = [max(picture.height for picture in row) for row in pictures]
    width = max(sum(picture.width for picture in row) for row in pictures)
    sheet = Image.new("RGB", (width, sum(heights)), "white")
    y = 0
    for row, height in zip(pictures, heights):
        x = 0
        for picture in row:
            sheet.paste(picture, (x, y))
            x += picture.width
        y += height
    sheet.save(path, optimize=True)
