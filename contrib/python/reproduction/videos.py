# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The paper's videos 1-3 as Ogg/Theora, which VTK writes by itself."""
import functools
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from morula.files import replaced
from morula.render.films import write_ogg

from . import figure_3, figure_4, layout
from .pictures import Camera, common_view

FRAMES_PER_SECOND = 8


@dataclass(frozen=True)
class Video:
    """A run's states from the first to the one that the paper shows last;
    views are (field, its limits, cut open)."""

    scene: str
    views: tuple
    last_time: callable
    width: int = 320  # pixels of a view


def write(video, runs, path):
    """One frame for each output of the run."""
    run = runs[video.scene]
    end = video.last_time(run)
    times = [time for time in run.times if time <= end + 1e-9]
    camera = Camera(common_view([(run, end)]), video.width)
    frames = (frame(video, run, time, camera) for time in times)
    with replaced(path) as unfinished:
        write_ogg(frames, unfinished, FRAMES_PER_SECOND)


def frame(video, run, time, camera):
    """The picture (height, width, 3), bytes: the views with colour bars."""
    with plt.rc_context(layout.STYLE):
        drawn = [(*camera.cells(run, time, field, limits, cut), cut)
                 for field, limits, cut in video.views]
        height, width = drawn[0][0].shape[:2]
        top, bar, dpi = 30, 100, 100
        size = np.array([2 * ((len(drawn) * (width + bar) + 15) // 16 * 8),
                         (height + top + 15) // 16 * 16])
        figure = plt.figure(figsize=size / dpi, dpi=dpi, facecolor="white")
        for k, (image, colours, _) in enumerate(drawn):
            left = k * (width + bar)
            axes = figure.add_axes([left / size[0], 0, width / size[0],
                                    height / size[1]])
            axes.imshow(image, interpolation="nearest")
            axes.set_axis_off()
            bar_axes = figure.add_axes([(left + width) / size[0], 0.2,
                                        10 / size[0], 0.6])
            colours.draw_bar(figure, bar_axes)
        figure.text(0.01, 0.98,
                    f"{time:.1f} days, {run.cells_at(time):,} cells", va="top",
                    fontsize=11)
        figure.canvas.draw()
        picture = np.array(figure.canvas.buffer_rgba())[:, :, :3]
        plt.close(figure)
    return picture


INSIDE = (("generation", figure_4.GENERATIONS, True),
          ("energy_density", figure_4.ENERGIES, True))
VIDEOS = {
    "video-1": Video("fig-3b", (("generation", figure_3.GENERATIONS, False),
                                ("energy_density", figure_3.ENERGIES, False)),
                     lambda run: run.last_output),
    "video-2": Video("fig-4b", INSIDE, figure_4.picture_time),
    "video-3": Video("fig-4c", INSIDE, figure_4.picture_time),
}
PANELS = {name: functools.partial(write, video)
          for name, video in VIDEOS.items()}
