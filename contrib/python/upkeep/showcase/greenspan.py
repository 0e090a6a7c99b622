# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Greenspan's spheroid (1972): a ball whose cells use up oxygen at one rate
wherever they live.

    R² dR/dt = s/3 (R³ - max(R_n, R_i)³) - λ R_n³

The necrotic core R_n is where oxygen would fall below what cells need, from
R² - 3 R_n² + 2 R_n³/R = R_c²; the arrested one R_i where it falls below what
growth needs, from R² + 2 R_n³/R - 2 R_n³/R_i - R_i² = R_d².
"""
from dataclasses import dataclass

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


@dataclass(frozen=True)
class Parameters:
    """Of a cell line: radii of a spheroid in which necrosis and arrest begin,
    um; rates of growth, and a third of that at which the core fades, 1/day."""

    necrosis: float  # R_c
    arrest: float  # R_d
    growth: float  # s
    loss: float  # λ


def necrotic_radius(outer, line):
    if outer <= line.necrosis:
        return 0.0
    return brentq(lambda r: outer**2 - 3 * r**2 + 2 * r**3 / outer
                  - line.necrosis**2, 0, outer * (1 - 1e-9))


def arrested_radius(outer, necrotic, line):
    if necrotic == 0:
        return numpy.sqrt(max(0.0, outer**2 - line.arrest**2))

    def excess(r):
        return ((outer**2 + 2 * necrotic**3 / outer - line.arrest**2) * r
                - r**3 - 2 * necrotic**3)
    if excess(necrotic) * excess(outer) >= 0:
        return necrotic
    return brentq(excess, necrotic, outer)


def radii(outer, line):
    """R, R_n, R_i of spheroids of these outer radii, um: three rows."""
    necrotic = [necrotic_radius(r, line) for r in outer]
    arrested = [arrested_radius(r, n, line) for r, n in zip(outer, necrotic)]
    return numpy.array([outer, necrotic, arrested])


def course(start, days, line):
    """R, R_n, R_i on these days, um, from the outer radius `start` on the first
    of them."""
    def rate(_, outer):
        _, necrotic, arrested = radii(outer, line)[:, 0]
        grown = outer**3 - max(necrotic, arrested)**3
        return (line.growth / 3 * grown - line.loss * necrotic**3) / outer**2
    solution = solve_ivp(rate, (days[0], days[-1]), [start], t_eval=days,
                         rtol=1e-8, max_step=0.2)
    return radii(solution.y[0], line)
