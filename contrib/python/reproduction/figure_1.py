# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fig. 1 (d): a cube on a slip plane whose cells all divide at once."""
from . import layout
from .pictures import Camera, common_view

PICTURE_TIMES = (0.0, 0.5, 1.0)  # days: before, just divided, after
VOLUMES = (700.0, 1300.0)  # µm³


def draw_1d(runs, path):
    run = runs["fig-1d"]
    times = [run.output_nearest(time) for time in PICTURE_TIMES]
    camera = Camera(common_view([(run, times[-1])]), 260)
    images, colours = zip(*(camera.cells(run, time, "volume", VOLUMES)
                            for time in times))
    cubes = path.with_name("fig-1d-cubes.png")
    layout.picture_grid(
        cubes, "d", [layout.Row("", images, colours[0])],
        [f"$t$ = {time:g} d\n{run.cells_at(time):,} cells" for time in times],
        camera.micrometres_per_pixel, 100)
    below = path.with_name("fig-1d-curves.png")
    layout.curves(below, "", lambda axes: volume_and_number(axes, run),
                  right=0.65, bottom=0.9)
    layout.whole_figure(path, [[cubes, below]])
    cubes.unlink()
    below.unlink()


def volume_and_number(axes, run):
    """Mean cell volume, left, and number of cells, right, over time."""
    rows = run.statistics
    left, = axes.plot(rows["time"], rows["total_volume"] / rows["cells"],
                      color="tab:blue", label="mean cell volume $V_p$")
    axes.set(xlabel="Time [day]", ylabel="Mean cell volume [µm³]")
    other = axes.twinx()
    other.spines["right"].set_visible(True)
    right, = other.step(rows["time"], rows["cells"], where="post",
                        color="tab:red", label="number of cells $N_p$")
    other.set_ylabel("Number of cells")
    layout.scientific(other, "y", 3)
    other.set_ylim(0, 1.15 * rows["cells"].max())
    axes.set_ylim(0, 2 * rows["total_volume"][0] / rows["cells"][0])
    axes.legend(handles=[left, right], loc="lower right")


PANELS = {"fig-1d": draw_1d}
