# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Draws panels from runs that are there: python3 -m reproduction.draw DIR PANEL...

Needs a display; contrib/reproduce provides one. A panel that cannot be drawn does not keep the
others from it; the exit code is 1 then."""
import sys
import traceback
from pathlib import Path

from morula.command_line import tell
from morula.files import replaced
from morula.render.films import write_ogg
from morula.style import pixels, plt

from . import catalogue, layout
from .paper_run import Runs
from .panels import DRAW

FRAMES_PER_SECOND = 8


def draw_panel(panel, runs, path):
    if not panel.startswith("video"):
        figure = DRAW[panel](runs)
        figure.savefig(path)
        plt.close(figure)
    # A video takes minutes: is it older than its run?
    elif not path.is_file() or path.stat().st_mtime < (
            runs.directory / catalogue.PANELS[panel][0][0] / "statistics.csv").stat().st_mtime:
        with replaced(path) as unfinished:
            write_ogg(map(pixels, DRAW[panel](runs)), unfinished, FRAMES_PER_SECOND)
    tell(f"reproduce: {path}")


def draw_figures(panels, output):
    """Pastes together the figures of which all panels are there and one is new."""
    for figure, rows in catalogue.FIGURES.items():
        paths = [[output / f"{panel}.png" for panel in row] for row in rows]
        if set(panels) & set(sum(rows, ())) and all(p.is_file() for p in sum(paths, [])):
            layout.whole_figure(output / f"{figure}.png", paths)
            tell(f"reproduce: {output / figure}.png")


def main(output, panels):
    runs, drawn = Runs(output), []
    for panel in panels:
        try:
            suffix = ".ogv" if panel.startswith("video") else ".png"
            draw_panel(panel, runs, output / (panel + suffix))
            drawn.append(panel)
        except Exception:  # whatever it is: the others are drawn
            traceback.print_exc()
            tell(f"reproduce: {panel} could not be drawn")
    draw_figures(drawn, output)
    return 0 if len(drawn) == len(panels) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
