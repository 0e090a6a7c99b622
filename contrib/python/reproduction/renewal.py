# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth rates of the number of cells, from the cell cycle alone.

A cell waits W ~ Exp(Λ) in G0, divides half a cycle of T after its onset of S,
and its daughters wait anew half a cycle later. Far from the start the number of
cells grows as e^{rt} with 2 E[e^{-r (W + T)}] = 1 (the renewal equation).
"""
import math

import numpy as np
from scipy.optimize import brentq


def exact(duration=1.0, exit_rate=1.0):
    """The root r (1/day) of 2 e^{-rT} Λ / (Λ + r) = 1: doc/theory.md (6.4)."""
    return brentq(lambda r: 2 * math.exp(-r * duration) * exit_rate
                  / (exit_rate + r) - 1, 0, 10 * exit_rate)


def rounded_up(step, duration=1.0, exit_rate=1.0):
    """The same if the wait ends at the end of the step (days) in which it is
    over: W = k·step, geometrically distributed."""
    stay = math.exp(-exit_rate * step)

    def equation(r):
        shrink = math.exp(-r * step)
        return (2 * math.exp(-r * duration) * (1 - stay) * shrink
                / (1 - stay * shrink) - 1)

    return brentq(equation, 1e-9, 10 * exit_rate)


def expected_cells(step, end, founders=1.0, duration=1.0, exit_rate=1.0):
    """Times (days) and expected numbers of cells if all founders begin to
    wait at t = 0 and waits end at step ends; a tiny step gives the exact
    numbers. The step divides half the duration."""
    cycle = round(duration / step)
    stay = math.exp(-exit_rate * step)
    waiting = founders
    under_way = np.zeros(cycle)  # mothers' onsets, the latest first
    times = step * np.arange(round(end / step) + 1)
    cells = np.empty(len(times))
    for i in range(len(times)):
        cells[i] = (waiting + under_way[:cycle // 2].sum()
                    + 2 * under_way[cycle // 2:].sum())
        leaving = (1 - stay) * waiting
        waiting = stay * waiting + 2 * under_way[-1]
        under_way = np.concatenate([[leaving], under_way[:-1]])
    return times, cells
