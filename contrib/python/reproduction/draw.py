# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Draws panels from runs that are there: python3 -m reproduction.draw DIR PANEL...

Needs a display; contrib/reproduce provides one. A panel that cannot be drawn
does not keep the others from it; the exit code is 1 then.
"""
import sys
import time
import traceback
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

from . import (catalogue, figure_1, figure_2, figure_3, figure_4,  # noqa: E402
               layout, videos)
from .run_results import Runs  # noqa: E402

DRAW = {**figure_1.PANELS, **figure_2.PANELS, **figure_3.PANELS,
        **figure_4.PANELS, **videos.PANELS}


def is_current(path, directories):
    """Whether a file is younger than these runs."""
    return path.is_file() and all(
        path.stat().st_mtime > (directory / "statistics.csv").stat().st_mtime
        for directory in directories)


def draw_panel(panel, runs, output):
    """Draws one panel; videos, which take minutes, only if they are older
    than their run."""
    path = output / catalogue.file_of(panel)
    scenes = catalogue.PANELS[panel][0]
    if panel in videos.PANELS and is_current(
            path, [output / scene for scene in scenes]):
        print(f"reproduce: {path} is up to date", flush=True)
        return
    start = time.monotonic()
    DRAW[panel](runs, path)
    print(f"reproduce: {path} ({time.monotonic() - start:.0f} s)", flush=True)


def draw_figures(panels, output):
    """Pastes together the figures of which all panels are there and one is
    new."""
    for figure, rows in catalogue.FIGURES.items():
        names = [panel for row in rows for panel in row]
        if set(names) & set(panels) and all(
                (output / f"{name}.png").is_file() for name in names):
            layout.whole_figure(output / f"{figure}.png", [
                [output / f"{name}.png" for name in row] for row in rows])
            print(f"reproduce: {output / figure}.png", flush=True)


def draw_all(panels, runs, output):
    """Draws panels; those that could be drawn."""
    drawn = []
    for panel in panels:
        try:
            draw_panel(panel, runs, output)
            drawn.append(panel)
        except Exception:  # whatever it is: the others are drawn
            traceback.print_exc()
            print(f"reproduce: {panel} could not be drawn", file=sys.stderr,
                  flush=True)
    return drawn


def main(output, panels):
    runs = Runs(output)
    pictures = [panel for panel in panels if panel not in videos.PANELS]
    drawn = draw_all(pictures, runs, output)
    draw_figures(drawn, output)
    drawn += draw_all([panel for panel in panels if panel in videos.PANELS],
                      runs, output)
    return 0 if len(drawn) == len(panels) else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
