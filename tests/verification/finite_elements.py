# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A body-fitted finite-element reference for blocks in plane strain.

Total Lagrangian, the neo-Hookean material of material.py, Lagrange elements of
high degree on Gauss-Lobatto points, held sides exactly held. It shares nothing
with Morula but the equations.
"""
from dataclasses import dataclass

import numpy
from numpy.polynomial import legendre
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

NEWTON_TOLERANCE = 1e-8  # µm, of the last correction; the next is its square


def lobatto_points(degree):
    """degree + 1 points on [-1, 1] with both ends."""
    inner = legendre.Legendre.basis(degree).deriv().roots()
    return numpy.concatenate([[-1.0], numpy.sort(inner.real), [1.0]])


def lagrange(points, xi):
    """Values and derivatives (len(xi), len(points)) of Lagrange's polynomials,
    through the Vandermonde matrix of Legendre polynomials."""
    degree = len(points) - 1
    to_nodal = numpy.linalg.inv(legendre.legvander(points, degree))
    slopes = numpy.stack([legendre.Legendre.basis(k).deriv()(xi)
                          for k in range(degree + 1)], axis=-1)
    return legendre.legvander(xi, degree) @ to_nodal, slopes @ to_nodal


class Axis:
    """One direction: element edges in µm, and the nodes on them."""

    def __init__(self, edges, degree):
        self.edges, self.degree = numpy.asarray(edges, dtype=float), degree
        self.points = lobatto_points(degree)
        self.lengths = numpy.diff(self.edges)
        self.n_elements = len(self.lengths)
        self.n_nodes = self.n_elements * degree + 1

    def nodes(self):
        middle = self.edges[:-1] + self.lengths / 2
        inside = (middle[:, None] + self.lengths[:, None] / 2
                  * self.points[:-1]).ravel()
        return numpy.append(inside, self.edges[-1])

    def locate(self, x):
        """Element and local coordinate of positions."""
        element = numpy.clip(numpy.searchsorted(self.edges, x) - 1, 0,
                             self.n_elements - 1)
        local = (x - self.edges[element]) / self.lengths[element]
        return element, 2 * local - 1


@dataclass
class Block:
    """[0, length] x [0, height]: two axes, Lame's constants, a dead force per
    initial volume (kPa/µm), and the displacements of held sides: functions of
    the load factor for 'bottom', 'top', 'left'."""

    axes: tuple
    constants: tuple
    force: tuple = (0.0, 0.0)
    held: dict = None

    def solve(self, n_loads=2):
        """The solution at full load, reached in equal increments."""
        self.prepare()
        u = numpy.zeros(2 * self.n_nodes)
        for k in range(1, n_loads + 1):
            u = self._newton(u, k / n_loads)
        self.u = u.reshape(-1, 2)
        return self

    def prepare(self):
        x_axis, y_axis = self.axes
        self.n_nodes = x_axis.n_nodes * y_axis.n_nodes
        local = numpy.arange(x_axis.degree + 1)
        self.numbers = numpy.array([
            ((j * y_axis.degree + local)[:, None] * x_axis.n_nodes
             + i * x_axis.degree + local).ravel()
            for j in range(y_axis.n_elements)
            for i in range(x_axis.n_elements)])
        xi, weights = legendre.leggauss(x_axis.degree + 2)
        N, D = lagrange(x_axis.points, xi)
        self.values = numpy.einsum("qj,pi->qpji", N, N).reshape(
            len(xi)**2, -1)
        across = numpy.stack([numpy.einsum("qj,pi->qpji", N, D),
                              numpy.einsum("qj,pi->qpji", D, N)], axis=-1)
        across = across.reshape(len(xi)**2, -1, 2)
        sizes = numpy.array([[dx, dy] for dy in y_axis.lengths
                             for dx in x_axis.lengths])
        self.slopes = across * 2 / sizes[:, None, None, :]
        self.weights = (numpy.outer(weights, weights).ravel()
                        * sizes.prod(axis=1)[:, None] / 4)

    def _held(self, factor):
        """Numbers and values of the prescribed unknowns."""
        x_axis, y_axis = self.axes
        grid = numpy.arange(self.n_nodes).reshape(y_axis.n_nodes,
                                                  x_axis.n_nodes)
        sides = {"bottom": grid[0], "top": grid[-1], "left": grid[:, 0]}
        numbers, values = [], []
        for side, displacement in self.held.items():
            for component, value in enumerate(displacement(factor)):
                numbers.append(2 * sides[side] + component)
                values.append(numpy.full(len(sides[side]), value))
        return numpy.concatenate(numbers), numpy.concatenate(values)

    def _newton(self, u, factor):
        numbers, values = self._held(factor)
        free = numpy.setdiff1d(numpy.arange(len(u)), numbers)
        step = numpy.zeros(len(u))
        step[numbers] = values - u[numbers]
        for _ in range(30):
            residual, K = self.assemble(u, factor)
            right = -residual[free] - (K @ step)[free]
            step[free] = spsolve(K[free][:, free], right,
                                 permc_spec="MMD_AT_PLUS_A")
            u = u + step
            if numpy.abs(step).max() <= NEWTON_TOLERANCE:
                return u
            step = numpy.zeros(len(u))
        raise RuntimeError("the finite-element reference does not converge")

    def assemble(self, u, factor):
        """Residual and tangent matrix."""
        lame_lambda, mu = self.constants
        local = u.reshape(-1, 2)[self.numbers]
        F = numpy.eye(2) + numpy.einsum("ena,eqnb->eqab", local, self.slopes)
        G = numpy.swapaxes(numpy.linalg.inv(F), -1, -2)
        ln_J = numpy.log(numpy.linalg.det(F))[..., None, None]
        P = mu * (F - G) + lame_lambda * ln_J * G
        forces = numpy.einsum("eq,eqab,eqnb->ena", self.weights, P,
                              self.slopes)
        forces -= factor * numpy.einsum("eq,qn,a->ena", self.weights,
                                        self.values, numpy.array(self.force))
        identity = numpy.eye(2)
        A = (mu * numpy.einsum("ac,bd->abcd", identity, identity)
             + (mu - lame_lambda * ln_J)[..., None, None]
             * numpy.einsum("eqad,eqcb->eqabcd", G, G)
             + lame_lambda * numpy.einsum("eqab,eqcd->eqabcd", G, G))
        n_elements, n_points, n, _ = self.slopes.shape
        half = numpy.einsum("eq,eqnb,eqabcd->enacqd", self.weights,
                            self.slopes, A, optimize=True)
        K = (half.reshape(n_elements, 4 * n, 2 * n_points)
             @ numpy.swapaxes(self.slopes, 2, 3).reshape(
                 n_elements, 2 * n_points, n))
        K = K.reshape(n_elements, n, 2, 2, n).swapaxes(3, 4)
        unknowns = (2 * self.numbers[:, :, None] + numpy.arange(2)).reshape(
            len(self.numbers), -1)
        rows = numpy.repeat(unknowns, 2 * n, axis=1).ravel()
        columns = numpy.tile(unknowns, (1, 2 * n)).ravel()
        residual = numpy.bincount(unknowns.ravel(), forces.ravel(), len(u))
        return residual, coo_matrix((K.ravel(), (rows, columns)),
                                    shape=(len(u), len(u))).tocsr()

    def evaluate(self, X):
        """Displacements (n, 2) and gradients F (n, 2, 2) at positions X."""
        x_axis, y_axis = self.axes
        i, xi = x_axis.locate(X[:, 0])
        j, eta = y_axis.locate(X[:, 1])
        local = self.u[self.numbers[j * x_axis.n_elements + i]].reshape(
            len(X), y_axis.degree + 1, x_axis.degree + 1, 2)
        N_x, D_x = lagrange(x_axis.points, xi)
        N_y, D_y = lagrange(y_axis.points, eta)
        contract = "pjic,pj,pi->pc"
        u = numpy.einsum(contract, local, N_y, N_x)
        slope_x = numpy.einsum(contract, local, N_y, D_x)
        slope_y = numpy.einsum(contract, local, D_y, N_x)
        F = numpy.stack([slope_x * (2 / x_axis.lengths[i])[:, None],
                         slope_y * (2 / y_axis.lengths[j])[:, None]], axis=-1)
        return u, numpy.eye(2) + F
