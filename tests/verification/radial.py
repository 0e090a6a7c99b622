# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A free sphere, or a disc in plane strain, that grows by theta(R).

With the elastic stretches a = ln(r'/theta) along and b = ln(r/(R theta)) across
the radius, F_g = theta I, and W = 1 or theta^dim per initial volume, the first
Piola-Kirchhoff stresses are P_r = W tau_r / r' and P_t = W tau_t R / r.
Equilibrium dP_r/dR = -(dim - 1) (P_r - P_t) / R and compatibility
db/dR = (exp(a - b) - 1)/R - theta'/theta are two ordinary differential
equations. They are solved by shooting from the centre, where a = b, for
P_r = 0 outside, to a relative tolerance of 1e-12.
"""
from dataclasses import dataclass

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

TOLERANCE = 1e-12


@dataclass
class Layer:
    """begin <= R <= end (µm) grows by theta(R); slope is d theta/dR."""

    begin: float
    end: float
    theta: object
    slope: object


class GrowingBall:
    """Solution for concentric layers, the first of which begins at R = 0."""

    def __init__(self, layers, constants, dim, per_grown_volume):
        self.layers, self.dim = layers, dim
        self.lame_lambda, self.mu = constants
        self.weight_power = dim if per_grown_volume else 0
        ends = [layer.theta(R) for layer in layers
                for R in (layer.begin, layer.end)]
        largest = 1e-3 + numpy.log(max(ends) / min(ends))
        if self.lame_lambda > 0:  # a pressure of some mu compresses no more
            largest = min(largest, 10 * self.mu / self.lame_lambda)
        centre = brentq(self._outer_stress, -largest, largest, xtol=1e-15,
                        rtol=1e-14)
        self.solutions = self._integrate(centre)

    def _tau(self, stretch, a, b):
        ln_J_e = a + (self.dim - 1) * b
        return (self.mu * (numpy.exp(2 * stretch) - 1)
                + self.lame_lambda * ln_J_e)

    def _piola(self, theta, a, b):
        weight = theta**self.weight_power
        return (weight * self._tau(a, a, b) / (theta * numpy.exp(a)),
                weight * self._tau(b, a, b) / (theta * numpy.exp(b)))

    def _rates(self, R, state, layer):
        a, b = state
        theta, growth = layer.theta(R), layer.slope(R) / layer.theta(R)
        P_r, P_t = self._piola(theta, a, b)
        rate_b = numpy.expm1(a - b) / R - growth
        factor = theta**(self.weight_power - 1) * numpy.exp(-a)
        # dP_r/dR at fixed a, then by a: solved for da/dR
        known = ((self.weight_power - 1) * growth * P_r
                 + factor * self.lame_lambda * (self.dim - 1) * rate_b)
        by_a = (factor * (2 * self.mu * numpy.exp(2 * a) + self.lame_lambda)
                - P_r)
        return [(-(self.dim - 1) * (P_r - P_t) / R - known) / by_a, rate_b]

    def _integrate(self, centre):
        """One dense solution a layer, for a = b = centre at R = 0."""
        state, begin, before, solutions = [centre, centre], None, None, []
        for layer in self.layers:
            if begin is None:
                begin = 1e-7 * self.layers[-1].end
            else:
                state = self._cross(layer, *state, before)
                begin = layer.begin
            solution = solve_ivp(self._rates, (begin, layer.end), state,
                                 method="DOP853", args=(layer,),
                                 dense_output=True, rtol=TOLERANCE,
                                 atol=1e-2 * TOLERANCE)
            solutions.append(solution.sol)
            state, before = solution.y[:, -1], layer
        return solutions

    def _cross(self, layer, a, b, before):
        """r and P_r are continuous where theta jumps."""
        theta_before = before.theta(layer.begin)
        theta = layer.theta(layer.begin)
        P_r, _ = self._piola(theta_before, a, b)
        b = b + numpy.log(theta_before / theta)
        return [brentq(lambda a: self._piola(theta, a, b)[0] - P_r, -5, 5,
                       xtol=1e-15, rtol=1e-14), b]

    def _outer_stress(self, centre):
        a, b = self._integrate(centre)[-1](self.layers[-1].end)
        return self._piola(self.layers[-1].theta(self.layers[-1].end), a, b)[0]

    def stretches(self, R):
        """r', r/R and theta at radii R in µm."""
        R = numpy.asarray(R, dtype=float)
        result = numpy.empty((3,) + R.shape)
        for layer, solution in zip(self.layers, self.solutions):
            here = (R >= layer.begin) & (R <= layer.end)
            if not here.any():
                continue
            theta = layer.theta(R[here])
            a, b = solution(numpy.maximum(R[here], solution.t_min))
            result[0, here] = theta * numpy.exp(a)
            result[1, here] = theta * numpy.exp(b)
            result[2, here] = theta
        return result

    def motion(self, X):
        _, across, _ = self.stretches(numpy.linalg.norm(X, axis=1))
        return X * across[:, None]

    def gradient(self, X):
        """F in space; F_zz = 1 in plane strain."""
        R = numpy.linalg.norm(X, axis=1)
        along, across, _ = self.stretches(R)
        n = X / R[:, None]
        F = across[:, None, None] * numpy.eye(self.dim)
        return F + ((along - across)[:, None, None]
                    * n[:, :, None] * n[:, None, :])
