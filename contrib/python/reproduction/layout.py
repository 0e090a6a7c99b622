# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How panels are laid out: grids of pictures, curves, whole figures."""
from morula.style import plt
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from PIL import Image

DPI = 150
plt.rcParams.update({
    "font.size": 9, "axes.linewidth": 0.7, "axes.spines.top": False, "axes.spines.right": False,
    "axes.titlesize": 9, "legend.frameon": False, "legend.fontsize": 8, "lines.linewidth": 1.6,
    "figure.dpi": DPI, "figure.constrained_layout.use": True})


def letter(figure, name):
    """The panel's letter, top left."""
    figure.suptitle(name, x=0.01, ha="left", fontsize=13, fontweight="bold")


def picture_grid(name, rows, titles, camera, bar_length):
    """A figure of rows of pictures, {label: [(picture, colours), ...]}, below titles."""
    width, height = (pixels / DPI for pixels in camera.view.pixels(camera.width))
    bar = any(colours for row in rows.values() for _, colours in row)
    figure = plt.figure(figsize=(len(titles) * width + (1.3 if bar else 0.2),
                                 len(rows) * height + 1.0))
    fill(figure, rows, titles, camera, bar_length)
    letter(figure, name)
    return figure


def fill(figure, rows, titles, camera, bar_length):
    """Draws the pictures with a scale bar (µm) at the bottom, and a colour bar at the
    right of those of equal colours."""
    grid = figure.subplots(len(rows), len(titles), squeeze=False)
    for row, (label, pictures) in zip(grid, rows.items()):
        row[0].set_ylabel(label)
        following = [*pictures[1:], (None, None)]
        for axes, (picture, colours), (_, further) in zip(row, pictures, following):
            axes.imshow(picture, extent=camera.extent, interpolation="nearest")
            axes.set(xticks=[], yticks=[], frame_on=False)
            if colours and (further is None or further.label != colours.label):
                bar = axes.inset_axes([1.02, 0.1, 0.05, 0.8])
                colours.draw_bar(axes.figure, bar)
                bar.yaxis.label.set_size(8)
                bar.tick_params(labelsize=7.5)
    for axes, title in zip(grid[0], titles):
        axes.set_title(title)
    grid[-1, 0].add_artist(AnchoredSizeBar(
        grid[-1, 0].transData, bar_length, f"{bar_length:g} µm", "upper left", frameon=False,
        size_vertical=0.01 * camera.view.half_height, label_top=True,
        bbox_to_anchor=(0, 0), bbox_transform=grid[-1, 0].transAxes))


def curves(name, draw, size=(3.5, 2.9)):
    """A figure of curves that draw(axes) fills; its size is in inches."""
    figure, axes = plt.subplots(figsize=size)
    draw(axes)
    letter(figure, name)
    return figure


def whole_figure(path, rows):
    """Pastes together panels that were drawn already, row by row."""
    pictures = [[Image.open(panel).convert("RGB") for panel in row] for row in rows]
    heights = [max(picture.height for picture in row) for row in pictures]
    width = max(sum(picture.width for picture in row) for row in pictures)
    sheet = Image.new("RGB", (width, sum(heights)), "white")
    for i, row in enumerate(pictures):
        for k, picture in enumerate(row):
            sheet.paste(picture, (sum(p.width for p in row[:k]), sum(heights[:i])))
    sheet.save(path, optimize=True)
