# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pictures within the page, as data: addresses."""
import base64
import io
import tempfile
from contextlib import redirect_stdout
from pathlib import Path

from cycler import cycler
from morula.render import tool as render
from morula.style import COLOURS, RC, plt
from PIL import Image

WIDTH, MOST = 1600, 4  # pixels; pictures of the run's directory
STYLE = {**RC, "axes.grid": True, "grid.color": "0.9", "legend.fontsize": 8,
         "axes.prop_cycle": cycler(color=COLOURS)}


def address(content, kind):
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def drawn(draw, size=(4.6, 2.7)):
    """The picture that `draw` makes on axes of a figure of this size (inches)."""
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=size, layout="constrained")
        draw(figure.add_subplot())
        return saved(figure)


def saved(figure):
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", metadata={"Date": None})
    plt.close(figure)
    return address(stream.getvalue(), "svg+xml")


def colour_bar(colours):
    with plt.rc_context(RC):
        width = 0.9 + colours.longest_name
        figure = plt.figure(figsize=(width, 4))
        colours.draw_bar(figure, figure.add_axes([0.1 / width, 0.05, 0.15 / width, 0.9]))
        return saved(figure)


def pictures(run):
    """(address, words) of the PNG files of the run's directory, or else of one by
    morula render: the last state from outside and cut open."""
    found = sorted(run.directory.glob("*.png"))[:MOST]
    if found:
        return [(photograph(file), file.name) for file in found]
    if not len(run.times):
        return []
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "cells.png"
        field = "type" if run.type_names else "energy_density"
        with redirect_stdout(io.StringIO()):
            code = render.main([str(run.directory), "--panels", "2", "--field", field,
                                "--output", str(file)])
        if code:
            return []
        return [(photograph(file), "The last state, drawn by morula render.")]


def photograph(file):
    stream = io.BytesIO()
    with Image.open(file) as image:
        image = image.convert("RGB")
        image.thumbnail((WIDTH, 10 * WIDTH))
        image.save(stream, "JPEG", quality=85, optimize=True)
    return address(stream.getvalue(), "jpeg")
