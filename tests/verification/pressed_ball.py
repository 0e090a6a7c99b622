# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball between two rigid planes without friction, in linear elasticity.

Hertz takes the ball for a half-space and its surface for a paraboloid. Here it is
a ball, of radius 1: with omega = r^n P_n(cos theta), n even, the displacements

    u = A grad(omega) + B (r^2 grad(omega) + alpha x omega),
    alpha = -2 (n lambda + (3n + 1) mu)/((n + 3) lambda + (n + 5) mu)

need no force inside, and two numbers A, B for each n give any traction of the
surface that has the ball's symmetry. The planes push along the axis by

    p = sum over k = 1, 2, ... of c_k s^(2k - 1), s^2 = (cos theta - cos b)/(1 - cos b)

where theta < b; the first term is Hertz' pressure. For each b the c_k and the way
delta of a plane are such that cos theta + u_z = 1 - delta at as many angles as
there are unknowns: there the surface lies on the plane. What is left out is what
linear elasticity leaves out, a part of the order of delta.
"""
import numpy
from scipy.optimize import brentq
from scipy.special import roots_legendre

MOST = 2000  # degree of the last polynomial
PRESSURES = 4  # k


def legendre(most, x):
    """P_n(x) for n = 0 ... most, a row each."""
    P = numpy.empty((most + 1, len(x)))
    P[0], P[1] = 1, x
    for n in range(1, most):
        P[n + 1] = ((2 * n + 1) * x * P[n] - n * P[n - 1]) / (n + 1)
    return P


class Ball:
    """Radius 1, with Lame's constants."""

    def __init__(self, constants, most=MOST):
        self.constants, self.most = constants, most
        self.n = n = numpy.arange(0, most + 1, 2)
        lame_lambda, mu = constants
        self.alpha = (-2 * (n * lame_lambda + (3 * n + 1) * mu)
                      / ((n + 3) * lame_lambda + (n + 5) * mu))

    def coefficients(self, radial, tangential):
        """A and B for the traction sum of radial_n P_n along r and of
        tangential_n dP_n/dtheta along theta; tractions in rows give rows."""
        lame_lambda, mu = self.constants
        n, alpha = self.n, self.alpha
        # The tractions of the two solutions.
        r = (2 * mu * n * (n - 1),
             lame_lambda * (2 * n + alpha * (n + 3))
             + 2 * mu * (n + alpha) * (n + 1))
        t = 2 * mu * (n - 1), mu * (2 * n + alpha)
        determinant = r[0] * t[1] - r[1] * t[0]
        determinant[0] = r[1][0]  # where only B has a displacement
        A = (radial * t[1] - tangential * r[1]) / determinant
        B = (tangential * r[0] - radial * t[0]) / determinant
        A[..., 0], B[..., 0] = 0, radial[..., 0] / determinant[0]
        return A, B

    def displacement(self, A, B, r, x):
        """u_r and u_theta at radii r and x = cos theta."""
        P = legendre(self.most + 1, x)
        n, alpha = self.n[:, None], self.alpha[:, None]
        inner, outer = r ** numpy.maximum(n - 1.0, 0), r ** (n + 1.0)
        u_r = (A @ (n * inner * P[self.n])
               + B @ ((n + alpha) * outer * P[self.n]))
        # sin(theta) dP_n/dtheta
        slope = (n * (n + 1) / (2 * n + 1)
                 * (P[self.n + 1] - P[numpy.maximum(self.n - 1, 0)]))
        sine = numpy.sqrt(1 - x**2)
        u_theta = (A @ (inner * slope) + B @ (outer * slope)
                   ) / numpy.where(sine > 0, sine, 1)
        return u_r, u_theta

    def axial(self, A, B, x):
        """u_z of the surface at x = cos theta."""
        u_r, u_theta = self.displacement(A, B, numpy.ones_like(x), x)
        return x * u_r - numpy.sqrt(1 - x**2) * u_theta

    def pushed(self, b, pressures):
        """A and B for the powers s, s^3, ... within the angle b on both sides, a
        row each, and the force of each."""
        x, weights = cap(b, max(200, int(self.most * b)))
        P = legendre(self.most + 1, x)
        q = powers(b, x, pressures) @ (weights[:, None] * P.T)
        n = self.n
        below = numpy.where(n > 0, q[:, numpy.maximum(n - 1, 0)], 0)
        above = q[:, n + 1]
        # -p e_z = -p cos(theta) e_r + p sin(theta) e_theta, by the recurrences
        # of x P_n and (1 - x^2) dP_n/dx.
        return (*self.coefficients(-(n + 1) * above - n * below, above - below),
                2 * numpy.pi * q[:, 0])


def cap(b, count):
    """Places x = cos theta and weights for integrals over x where theta < b, of
    functions that are smooth in s."""
    s, weights = roots_legendre(count)
    s, top = (s + 1) / 2, 1 - numpy.cos(b)
    return 1 - top * (1 - s**2), weights * top * s


def powers(b, x, pressures):
    """s, s^3, ... at x = cos theta, a row each; 0 beyond the edge."""
    top = 1 - numpy.cos(b)
    s = numpy.sqrt(numpy.maximum(x - 1 + top, 0) / top)
    return s ** (2 * numpy.arange(pressures)[:, None] + 1)


class Contact:
    """The ball touches the plane within the angle b.

    layer: how deep the surface goes into the plane for a pressure of 1.
    """

    def __init__(self, ball, b, layer=0.0, pressures=PRESSURES):
        self.ball, self.b, self.pressures = ball, b, pressures
        # From the middle to the edge.
        x = numpy.cos(b * numpy.sin(numpy.linspace(0, numpy.pi / 2,
                                                   pressures + 1)))
        A, B, forces = ball.pushed(b, pressures)
        columns = ball.axial(A, B, x) - layer * powers(b, x, pressures)
        matrix = numpy.column_stack([*columns, numpy.ones_like(x)])
        *c, self.delta = numpy.linalg.solve(matrix, 1 - x)
        self.c, self.force = numpy.array(c), numpy.dot(c, forces)
        self.solution = self.c @ A, self.c @ B

    def pressure(self, x):
        """On the surface at x = cos theta."""
        return self.c @ powers(self.b, x, self.pressures)

    def height(self, x):
        """z of the surface that was at x = cos theta."""
        return x + self.ball.axial(*self.solution, x)


def force(ball, delta, layer=0.0):
    """Force on a plane that has come delta nearer to the centre."""
    b = brentq(lambda b: Contact(ball, b, layer).delta - delta,
               0.5 * delta**0.5, 2 * delta**0.5, xtol=1e-8)
    return Contact(ball, b, layer).force


def hertz(delta, E, nu):
    """Hertz' force, that of a half-space, for R = 1."""
    return 4 * E * delta**1.5 / (3 * (1 - nu**2))
