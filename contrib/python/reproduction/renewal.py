# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth of the number of cells, from the cell cycle alone.

A cell waits W ~ Exp(Λ) in G0, divides half a cycle of T after its onset of S, and its daughters
wait anew half a cycle later. Far from the start the number of cells grows as e^{rt} with 2 E[e^{-r
(W + T)}] = 1 (the renewal equation). Here T = 1 day and Λ = 1/day, as in Fig. 3."""
import math

import numpy as np
from scipy.optimize import brentq


def rate(step=0.0):
    """r (1/day): doc/theory.md (6.4). With a step (days) the wait ends at the end of
    the step in which it is over: it is distributed geometrically."""
    def mean_of_wait(r):
        if not step:
            return 1 / (1 + r)
        return (1 - math.exp(-step)) / (math.exp(r * step) - math.exp(-step))

    return brentq(lambda r: 2 * math.exp(-r) * mean_of_wait(r) - 1, 1e-9, 10)


def expected_cells(step, end, founders=1.0):
    """Times (days) and expected numbers of cells if all founders begin to wait at t = 0 and waits
    end at step ends; a tiny step gives the exact numbers. The step divides half a day."""
    cycle = round(1 / step)
    leaving = 1 - math.exp(-step)
    waiting = founders
    under_way = np.zeros(cycle)  # mothers' onsets, the latest first
    times = step * np.arange(round(end / step) + 1)
    cells = np.empty(len(times))
    for i in range(len(times)):
        cells[i] = waiting + under_way[:cycle // 2].sum() + 2 * under_way[cycle // 2:].sum()
        onset = leaving * waiting
        waiting += 2 * under_way[-1] - onset
        under_way = np.concatenate([[onset], under_way[:-1]])
    return times, cells
