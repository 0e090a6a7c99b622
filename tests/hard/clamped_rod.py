# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""When a rod that grows between two clamps is no longer stable, by body-fitted
finite elements (tests/verification/finite_elements.py) in plane strain.

Growth by theta is the elastic deformation of a rod of theta times the size whose
ends are squeezed to what the clamps leave. Half the rod, x >= 0; the bent shape
is symmetric about the middle like the straight one. Newton's method keeps the
straight rod straight: where its tangent is singular, rounding would bend it.
"""
import numpy
from scipy.optimize import brentq
from scipy.sparse.linalg import eigsh, spsolve

from tests.hard.stability import lame
from tests.verification.finite_elements import Axis, Block

DEGREE = 4
EDGES = numpy.array([0, .3, .55, .75, .88, .95, .985, 1])  # finer at the clamp
TOLERANCE = 1e-9  # µm, of the last correction


def smallest_eigenvalue(theta, length, thickness, nu=0.4):
    """Of the tangent of the straight rod that has grown by theta."""
    axes = (Axis(EDGES * length / 2, DEGREE),
            Axis(numpy.linspace(0, thickness, 5), DEGREE))
    rod = Block(axes, lame(nu=nu))
    rod.prepare()
    x, y = numpy.meshgrid(*(axis.nodes() for axis in axes))
    numbers = numpy.arange(x.size).reshape(x.shape)
    rod.slopes, rod.weights = rod.slopes / theta, rod.weights * theta**2
    u = numpy.zeros((x.size, 2))
    u[:, 0] = (1 - theta) * x.ravel()
    u[numbers[:, -1], 1] = (1 - theta) * (y[:, -1] - thickness / 2)
    held = numpy.concatenate([2 * numbers[:, 0], 2 * numbers[:, -1],
                              2 * numbers[:, -1] + 1])
    mirror = numbers[::-1].ravel()  # node at thickness - y

    def straight(displacements):
        """The part that is the same in the mirror y -> thickness - y."""
        pairs = displacements.reshape(-1, 2)
        return ((pairs + pairs[mirror] * [1, -1]) / 2).ravel()

    u = u.ravel()
    free = numpy.setdiff1d(numpy.arange(u.size), held)
    for _ in range(30):
        residual, K = rod.assemble(u, 1.0)
        K = K[free][:, free].tocsc()
        step = numpy.zeros_like(u)
        step[free] = spsolve(K, -straight(residual)[free])
        step = straight(step)
        u += step
        if numpy.abs(step).max() <= TOLERANCE:
            return eigsh(K, k=1, sigma=-1e-7)[0][0]
    raise RuntimeError("the straight rod does not converge")


def critical(length, thickness):
    """The growth at which the straight rod loses stability."""
    euler = (2 * numpy.pi * thickness / length)**2 / 12
    return brentq(lambda theta: smallest_eigenvalue(theta, length, thickness),
                  1 + 0.8 * euler, 1 + 1.3 * euler, xtol=1e-6)
