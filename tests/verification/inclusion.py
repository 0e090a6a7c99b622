# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A disc in plane strain, R <= 1, whose core R < 1/2 has another stiffness,
grows by theta everywhere while its surface keeps its place.

The core is deformed uniformly, r = s R. In the shell, with a = ln(r'/theta) and
b = ln(r/(R theta)), equilibrium dP_r/dR = -(P_r - P_t)/R and compatibility
db/dR = (exp(a - b) - 1)/R are two ordinary differential equations; s follows by
shooting for r(1) = 1.
"""
import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.verification.material import lame

CORE = 0.5


def _piola(constants, theta, a, b):
    lame_lambda, mu = constants
    ln_J_e = a + b
    return ((mu * numpy.expm1(2 * a) + lame_lambda * ln_J_e)
            / (theta * numpy.exp(a)),
            (mu * numpy.expm1(2 * b) + lame_lambda * ln_J_e)
            / (theta * numpy.exp(b)))


def _shell(s, core, shell, theta):
    centre = numpy.log(s / theta)
    P_r, _ = _piola(core, theta, centre, centre)
    a = brentq(lambda a: _piola(shell, theta, a, centre)[0] - P_r, -4, 4,
               xtol=1e-14)
    lame_lambda, mu = shell

    def rates(R, state):
        a, b = state
        P_r, P_t = _piola(shell, theta, a, b)
        rate_b = numpy.expm1(a - b) / R
        factor = numpy.exp(-a) / theta
        by_a = factor * (2 * mu * numpy.exp(2 * a) + lame_lambda) - P_r
        return [(-(P_r - P_t) / R - factor * lame_lambda * rate_b) / by_a,
                rate_b]

    return solve_ivp(rates, (CORE, 1), [a, centre], method="DOP853",
                     rtol=1e-11, atol=1e-13, dense_output=True)


def mean_energy(E_core, E_shell, nu, theta):
    """Mean energy density per initial volume, kPa."""
    core, shell = lame(E_core, nu), lame(E_shell, nu)

    def outer(s):
        return theta * numpy.exp(_shell(s, core, shell, theta).y[1, -1]) - 1

    s = brentq(outer, 0.999 * theta, 1.0005 * theta, xtol=1e-13)
    solution = _shell(s, core, shell, theta)
    R = CORE + (numpy.arange(4000) + 0.5) / 4000 * (1 - CORE)
    a, b = solution.sol(R)

    def density(constants, a, b):
        lame_lambda, mu = constants
        return (lame_lambda / 2 * (a + b)**2 + mu / 2 * (
            numpy.exp(2 * a) + numpy.exp(2 * b) - 2 - 2 * (a + b)))

    centre = numpy.log(s / theta)
    return (density(core, centre, centre) * CORE**2
            + numpy.average(density(shell, a, b), weights=R) * (1 - CORE**2))
