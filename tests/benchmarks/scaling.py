# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What more ranks cost, and a model of runs on a cluster. See the tables ranks,
rank_counts and model of doc/performance.md."""
import math

CELLS = ("tangent", "residual", "commit", "growth", "points", "nitsche",
         "division", "strays", "statistics")
# What the model takes a cluster to be.
LATENCY = 2e-6       # s, of a message
BANDWIDTH = 1e10     # bytes a second and rank
MESSAGES = 1         # reductions of a CG iteration
REACH = 2            # splines around own ones that these couple with
SUBSTITUTION = 0.3   # of an iteration, whose other part is the product
RINGS = 14           # around what a rank reaches (grid/grid_window), and its reach
RING = 6e-7          # s a step, of a grid cell of the rings


def counts(runner, proliferating, sphere):
    """Work by number of ranks; more ranks than cores only count."""
    rows = [("ranks", "linear iterations", "of one rank's", "Newton iterations",
             "cells at the end")]
    first = None
    for n in (1, 2, 4, 8, 16):
        run = runner.run(f"counts-{n}", proliferating,
                         sphere(200000, **{"Time/Step": 0.1,
                                           "Time/End time": 0.3}), n)
        iterations = run.total("linear_iterations")
        first = first or iterations
        rows.append((f"{n}", f"{iterations:.0f}", f"{iterations / first:.2f}",
                     f"{run.total('newton_iterations'):.0f}",
                     f"{int(run.rows[-1]['cells']):,}"))
    return rows


def last(run, column):
    return float(run.rows[-1][column])


def step_time(run, names):
    return run.time(*names) / (len(run.rows) - 1)


class Model:
    """Seconds of a step, from runs on one core of a small, a large tissue, and
    the small one on a finer grid."""

    def __init__(self, small, large, fine):
        cells = last(large, "cells")
        self.newton = large.total("newton_iterations") / (len(large.rows) - 1)
        self.per_cell = step_time(large, CELLS) / cells
        self.pattern, self.factor, self.iteration = (
            step_time(large, (name,)) / last(large, "unknowns")
            for name in ("sparsity pattern", "preconditioner",
                         "linear solver"))  # by row
        self.rows = last(large, "unknowns") / cells
        # The grid: a part for each cell, one for each row.
        self.grid_per_row = ((step_time(fine, ("grid",))
                              - step_time(small, ("grid",)))
                             / (last(fine, "unknowns")
                                - last(small, "unknowns")))
        self.per_cell += (step_time(large, ("grid",)) / cells
                          - self.grid_per_row * self.rows)
        per_newton = [run.total("linear_iterations")
                      / run.total("newton_iterations")
                      for run in (small, large)]
        self.cells, self.iterations = cells, per_newton[1]
        self.growth = (math.log(per_newton[1] / per_newton[0])
                       / math.log(cells / last(small, "cells")))

    def step(self, cells, ranks, penalty):
        """Parts of a step's seconds: by cell, by row, the grid, messages.
        penalty: iterations over those of one rank."""
        more = ((cells / self.cells)**self.growth
                * (penalty if ranks > 1 else 1))
        rows = self.rows * cells / ranks
        # All wait for the largest block, whose neighbours are all lower ranks.
        edge = (rows / 3)**(1 / 3)
        block = (1 + 2 * REACH / edge)**3 if ranks > 1 else 1
        by_row = (self.pattern + self.factor * block + self.iteration * more
                  * (1 - SUBSTITUTION + SUBSTITUTION * block))
        iterations = self.newton * self.iterations * more
        messages = iterations * (
            MESSAGES * LATENCY * math.log2(max(ranks, 1))
            + (6 * edge**2 * 3 * 8 / BANDWIDTH if ranks > 1 else 0))
        # A rank's window holds its own grid cells, and the rings around them.
        rings = min((edge + 2 * RINGS)**3, self.rows * cells / 3) - edge**3
        return (self.per_cell * cells / ranks, by_row * rows,
                self.grid_per_row * rows + RING * max(rings, 0), messages)


def model(runner, proliferating, sphere, penalty):
    keys = {"Time/Step": 0.1, "Time/End time": 0.3}
    small, large = (runner.run(f"model-{n}", proliferating, sphere(n, **keys))
                    for n in (20000, 400000))
    fine = runner.run("model-fine", proliferating,
                      {**sphere(20000, **keys), "Grid/Spacing": 25})
    fitted = Model(small, large, fine)
    rows = [("cells", "ranks", "s a step", "by cell", "by row of the matrix",
             "grid", "messages", "efficiency")]
    for cells in (1e6, 1e7, 1e8):
        alone = sum(fitted.step(cells, 1, penalty))
        for ranks in (1, 16, 128, 1024):
            parts = fitted.step(cells, ranks, penalty)
            rows.append((f"10^{math.log10(cells):.0f}".replace("^6", "⁶")
                         .replace("^7", "⁷").replace("^8", "⁸"), f"{ranks}",
                         f"{sum(parts):.2f}", *(f"{part:.3f}" for part in parts),
                         f"{100 * alone / sum(parts) / ranks:.0f} %"))
    return rows
