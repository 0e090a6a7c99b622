# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Fig. 3: a cube on a slip plane whose cells grow (a) or proliferate (b-e)."""
import functools

from morula import fits

from . import layout, stated
from .pictures import Camera, common_view

VOLUMES_3A = (900.0, 3500.0)  # µm³
GENERATIONS = (0, 4)
VOLUMES_3B = (300.0, 2200.0)  # µm³
ENERGIES = (0.0, 1.2)  # kPa


def draw_3a(runs, path):
    """The cube at every stretch that was written."""
    run = runs["fig-3a"]
    times = run.times
    camera = Camera(common_view([(run, times[-1])]), 200)
    images, colours = zip(*(camera.cells(run, time, "volume", VOLUMES_3A)
                            for time in times))
    layout.picture_grid(
        path, "a", [layout.Row("", images, colours[0])],
        [f"$\\theta$ = {run.stretch(time):.3g}" for time in times],
        camera.micrometres_per_pixel, 100)


def draw_3b(runs, path):
    """Generation, volume and energy density at five times."""
    run = runs["fig-3b"]
    end = run.last_output
    times = [run.output_nearest(end * k / 4) for k in range(5)]
    camera = Camera(common_view([(run, end)]), 240)
    rows = []
    for label, field, limits in (
            ("Generation", "generation", GENERATIONS),
            ("Cell volume $V_p$", "volume", VOLUMES_3B),
            ("Energy density $\\Psi_p$", "energy_density", ENERGIES)):
        images, colours = zip(*(camera.cells(run, time, field, limits)
                                for time in times))
        rows.append(layout.Row(label, images, colours[0]))
    layout.picture_grid(
        path, "b", rows,
        [f"$t$ = {time:g} d\n{run.cells_at(time):,} cells" for time in times],
        camera.micrometres_per_pixel, 100)


def draw_curve(which, runs, path):
    """A quantity over time with the paper's fitted function and ours."""
    curve = CURVES[which]
    rows = runs["fig-3b"].statistics
    time, values = rows["time"], rows[curve.column] * curve.to_shown

    def draw(axes):
        axes.plot(time, values, color="black", label="Morula")
        try:
            ours = curve.fit(time, rows[curve.column])
        except fits.NothingToFit:
            ours = None
        if ours:
            axes.plot(time, ours(time) * curve.to_shown, color="tab:blue",
                      linestyle="--", linewidth=1.1,
                      label=f"fit: {curve.text(ours)}")
        axes.plot(time, curve.paper(time) * curve.to_shown,
                  color="tab:orange", linestyle=":",
                  label=f"paper: {curve.text(curve.paper)}")
        axes.axvspan(*fits.RANGE, color="0.93", zorder=0, linewidth=0)
        axes.set(xlabel="Time [day]", ylabel=curve.label,
                 xlim=(0, time.max()), ylim=(min(0, values.min()), None))
        axes.legend(loc="upper left", borderaxespad=0.1, handlelength=1.6)

    layout.curves(path, which, draw)


class Curve:
    """One of Fig. 3 (c-e): a column of the statistics and its fit."""

    def __init__(self, column, label, to_shown, fit, paper, text):
        self.column, self.label, self.to_shown = column, label, to_shown
        self.fit, self.paper, self.text = fit, paper, text


CURVES = {
    "c": Curve("cells", "Number of cells $N_p$ [10³]", 1e-3,
               fits.fit_exponential, stated.CELLS_FIT,
               lambda f: f"{f.factor:.0f}$\\,e^{{{f.rate:.3g}t}}$"),
    "d": Curve("total_volume", "Total volume $V_{tot}$ [10⁶ µm³]", 1e-6,
               fits.fit_exponential, stated.VOLUME_FIT,
               lambda f: f"{f.factor * 1e-6:.3g}·10⁶$\\,e^{{{f.rate:.3g}t}}$"),
    "e": Curve("mean_energy_density", "Mean energy density $\\Psi_{ave}$ [kPa]",
               1.0, fits.fit_line, stated.ENERGY_FIT,
               lambda f: f"{f.slope:.3g}$\\,t$ {f.constant:+.3f}".replace(
                   "-", "− ").replace("+", "+ ")),
}
PANELS = {"fig-3a": draw_3a, "fig-3b": draw_3b,
          **{f"fig-3{which}": functools.partial(draw_curve, which)
             for which in CURVES}}
