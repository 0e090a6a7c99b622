# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Series of tumour spheroids: the data, what was fitted to them, the scene of
each, and what its run says."""
import csv
from dataclasses import dataclass
from pathlib import Path

import numpy
from morula.run import Run

from .greenspan import Parameters, course

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT / "doc/data/spheroids.csv"
SCENE = ROOT / "prm/showcase/spheroid.prm"

# Least squares of Greenspan's radii to all series of a line (contrib/upkeep/showcase
# --fit): the line's parameters, and an outer radius on the first day of each.
LINES = {"WM983b": Parameters(221.2, 187.2, 0.3684, 0.2336),
         "WM793b": Parameters(250.1, 202.3, 0.1668, 0.0481)}
STARTS = {("WM983b", 2500): 132.4, ("WM983b", 10000): 194.9,
          ("WM793b", 2500): 133.2, ("WM793b", 5000): 176.8,
          ("WM793b", 10000): 216.7}

DEATH = 0.2  # oxygen of the medium at which cells die, chosen


@dataclass(frozen=True)
class Series:
    """Spheroids of a line that were seeded alike: days, and the means of R, R_n,
    R_i on each, um, with the standard deviation of R."""

    line: str
    seeded: int
    days: numpy.ndarray
    radii: numpy.ndarray
    deviation: numpy.ndarray

    @property
    def name(self):
        return f"{self.line}, {self.seeded} cells"

    @property
    def parameters(self):
        return LINES[self.line]

    @property
    def start(self):
        return STARTS[self.line, self.seeded]

    def greenspan(self, days=None):
        """R, R_n, R_i of the equations."""
        return course(self.start, self.days if days is None else days,
                      self.parameters)

    def overrides(self):
        """What is special in the scene of this series, as (key, value)."""
        line = self.parameters
        arrest = 1 - (1 - DEATH) * (line.arrest / line.necrosis)**2
        rate = (f"if(type == necrotic, {-3 * line.loss:.4f}, {line.growth}*"
                f"((oxygen > {arrest:.4f}) - (cycle_phase > 0 && "
                "cycle_phase < 9)))")
        return (("Time/End time", f"{self.days[-1] - self.days[0]:g}"),
                ("Tissue/Radius", f"{settled(self.start):.1f}"),
                ("Fields/oxygen/Diffusion", f"{line.necrosis}^2"),
                ("Growth/Rate/Rate", rate),
                ("Proliferation/Cell cycle/Duration",
                 f"{numpy.log(2) / line.growth:.4f}"))


def settled(radius):
    """The radius with which a run starts that is to have this one. All cells
    stand before their cycle at t = 0. As the growth of a cycle is linear in
    time, they are worth a volume that is 1/(2 ln² 2) = 1.0407 times theirs, once
    they are spread over the cycle: the mean of 1 + a over the steady ages a,
    whose density falls as 2^-a, by that of 2^a."""
    return radius * (2 * numpy.log(2)**2)**(1 / 3)


def all_series():
    with DATA.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file
                                   if not line.startswith("#")))
    found = []
    for line, seeded in STARTS:
        kept = [row for row in rows if row["cell_line"] == line
                and int(row["seeded_cells"]) == seeded]
        column = {name: numpy.array([float(row[name]) for row in kept])
                  for name in rows[0] if name != "cell_line"}
        outer = column["radius_mean_um"]
        found.append(Series(
            line, seeded, column["day"],
            numpy.array([outer, outer * column["necrotic_share_mean"],
                         outer * column["arrested_share_mean"]]),
            column["radius_sd_um"]))
    return found


def radii_of_run(directory):
    """Times of a run, days, and R, R_n, R_i then, um: radii of balls of the
    volume that the surface encloses, of the necrotic cells, and of all cells
    that have too little oxygen to grow."""
    run = Run(directory)
    arrest = float(run.keys["Growth/Rate/Rate"].split("oxygen > ")[1]
                   .split(")")[0])
    rows = []
    for i in range(len(run.times)):
        surface, cells = run.surface(i), run.cells(i)
        enclosed = sum(surface[x] * surface["n" + x] for x in "xyz")
        rows.append([ball((enclosed * surface["area"]).sum() / 3),
                     ball(cells["volume"][cells["type"] == 1].sum()),
                     ball(cells["volume"][cells["oxygen"] <= arrest].sum())])
    return run.times, numpy.array(rows).T


def ball(volume):
    """Radius of a ball."""
    return numpy.cbrt(3 * volume / (4 * numpy.pi))


def fit():
    """Least squares of the equations to the data of each line: {line: (the four
    parameters and the starting radii, root of the mean square, um)}."""
    from scipy.optimize import minimize
    found = {}
    for name in LINES:
        mine = [series for series in all_series() if series.line == name]

        def residual(values, mine=mine):
            line = Parameters(*values[:4])
            if line.arrest > line.necrosis or min(values) <= 0:
                return 1e3
            return numpy.sqrt(numpy.mean(numpy.concatenate(
                [course(start, series.days, line) - series.radii
                 for start, series in zip(values[4:], mine)], axis=1)**2))
        guess = [*vars(LINES[name]).values(),
                 *(series.radii[0, 0] for series in mine)]
        best = minimize(residual, guess, method="Nelder-Mead",
                        options={"maxiter": 2000, "xatol": 0.01,
                                 "fatol": 0.001})
        found[name] = best.x, best.fun
    return found
