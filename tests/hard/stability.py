# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""When growing layers and rings in plane strain become unstable.

Small displacements are superposed on a state that is known but for functions of
one coordinate: layers between slip walls (x across, waves along the surface,
u_x = U(Y) sin kx, u_y = V(Y) cos kx), or concentric rings (u_r = U(R) cos n phi,
u_phi = V(R) sin n phi). The second variation of the energy (1.4) of doc/theory.md
for one wave number is then a quadratic form of U and V on a line. Both the state
and the form use finite elements of degree 8 on that line; the state is stable
against that wave number while the form's smallest eigenvalue is positive. Nothing
is shared with Morula but the energy.

Energies are per initial volume (W = 1) and growth is isotropic in the plane.
"""
from dataclasses import dataclass

import numpy
from numpy.polynomial import legendre
from scipy.linalg import eigh
from scipy.optimize import brentq

DEGREE = 8


def lame(E=1.0, nu=0.4):
    """Lame's constants (lambda, mu), kPa."""
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


@dataclass
class Part:
    """begin <= Y or R <= end (µm), Young's modulus (kPa), growth theta(t)."""

    begin: float
    end: float
    E: float = 1.0
    theta: object = lambda t: 1.0
    nu: float = 0.4


class Line:
    """Finite elements on a line through all parts; arrays at Gauss points."""

    def __init__(self, parts, elements_per_part):
        edges = [parts[0].begin]
        owner = []
        for i, part in enumerate(parts):
            edges += list(numpy.linspace(part.begin, part.end,
                                         elements_per_part + 1)[1:])
            owner += [i] * elements_per_part
        edges, owner = numpy.array(edges), numpy.array(owner)
        basis = legendre.Legendre.basis
        nodes = numpy.concatenate(
            [[-1.0], numpy.sort(basis(DEGREE).deriv().roots().real), [1.0]])
        xi, weights = legendre.leggauss(DEGREE + 4)
        to_nodal = numpy.linalg.inv(legendre.legvander(nodes, DEGREE))
        slopes = numpy.stack([basis(k).deriv()(xi) for k in range(DEGREE + 1)],
                             axis=-1)
        length = numpy.diff(edges)
        self.numbers = (numpy.arange(len(length))[:, None] * DEGREE
                        + numpy.arange(DEGREE + 1))
        self.n = len(length) * DEGREE + 1
        middle = (edges[:-1] + edges[1:]) / 2
        self.nodes = numpy.append(
            (middle[:, None] + length[:, None] / 2 * nodes[:-1]).ravel(),
            edges[-1])
        self.x = middle[:, None] + length[:, None] / 2 * xi
        self.weights = length[:, None] / 2 * weights
        self.N = legendre.legvander(xi, DEGREE) @ to_nodal
        self.D = (slopes @ to_nodal)[None] * (2 / length)[:, None, None]
        constants = numpy.array([lame(part.E, part.nu) for part in parts])
        self.lame_lambda, self.mu = constants[owner].T[:, :, None]
        self.owner = owner

    def assemble(self, local):
        """The matrix of element matrices (e, a, i, b, j) of i, j components."""
        components = local.shape[2]
        unknowns = (components * self.numbers[:, :, None]
                    + numpy.arange(components)).reshape(len(local), -1)
        size = components * (DEGREE + 1)
        K = numpy.zeros((components * self.n, components * self.n))
        numpy.add.at(K, (unknowns[:, :, None], unknowns[:, None, :]),
                     local.reshape(len(local), size, size))
        return K


class GrowingParts:
    """Concentric rings (round) or layers between slip walls."""

    def __init__(self, parts, round_, held_begin=(), held_end=(),
                 elements_per_part=4):
        """Held: of 'normal' and 'tangential', what is zero at both ends."""
        self.parts, self.round = parts, round_
        self.line = Line(parts, elements_per_part)
        self.held = ([("normal", "tangential").index(name) for name in held_begin],
                     [("normal", "tangential").index(name) for name in held_end])
        self.solid = round_ and parts[0].begin == 0

    def state(self, t, start=None):
        """Positions r (or y) of the nodes in the unperturbed equilibrium."""
        line = self.line
        theta = numpy.array([part.theta(t) for part in self.parts])
        theta = theta[line.owner][:, None]
        r = line.nodes.copy() if start is None else start.copy()
        held = (([0] if 0 in self.held[0] or self.solid else [])
                + ([line.n - 1] if 0 in self.held[1] else []))
        if not (held or self.round):
            held = [0]  # a free layer may be anywhere
        free = numpy.setdiff1d(numpy.arange(line.n), held)
        measure = line.weights * (line.x if self.round else 1.0)
        for _ in range(60):
            local = r[line.numbers]
            along = numpy.einsum("eqa,ea->eq", line.D, local)
            across = (local @ line.N.T / line.x if self.round
                      else numpy.ones_like(along))
            ln_J_e = numpy.log(along * across / theta**2)
            p = [line.mu * (stretch / theta**2 - 1 / stretch)
                 + line.lame_lambda * ln_J_e / stretch
                 for stretch in (along, across)]
            B = [line.D, numpy.broadcast_to(line.N, line.D.shape)
                 / line.x[:, :, None] if self.round else 0 * line.D]
            force = numpy.zeros(line.n)
            numpy.add.at(force, line.numbers, sum(
                numpy.einsum("eq,eq,eqa->ea", measure, p[i], B[i])
                for i in range(2)))
            K = 0
            for i, s in enumerate((along, across)):
                A = (line.mu * (1 / theta**2 + 1 / s**2)
                     + line.lame_lambda * (1 - ln_J_e) / s**2)
                K = K + numpy.einsum("eq,eqa,eqb->eab", measure * A, B[i], B[i])
            mixed = measure * line.lame_lambda / (along * across)
            K = K + numpy.einsum("eq,eqa,eqb->eab", mixed, B[0], B[1])
            K = K + numpy.einsum("eq,eqa,eqb->eab", mixed, B[1], B[0])
            K = line.assemble(K[:, :, None, :, None])
            step = numpy.zeros(line.n)
            step[free] = numpy.linalg.solve(K[numpy.ix_(free, free)],
                                            -force[free])
            factor = 1.0
            while (numpy.diff(r + factor * step) <= 0).any():
                factor /= 2
            r = r + factor * step
            if numpy.abs(step).max() <= 1e-11 * line.nodes[-1]:
                return r, along, across, theta
        raise RuntimeError("the unperturbed state does not converge")

    def smallest_eigenvalue(self, wave_number, t):
        """Of the second variation; wave_number is k in 1/µm, or n."""
        return self.modes(wave_number, t)[0][0]

    def modes(self, wave_number, t):
        """Two smallest eigenvalues (scaled by the mass) and (U, V) of the
        first at the nodes."""
        line, k = self.line, wave_number
        r, along, across, theta = self.state(t)
        radius = r[line.numbers] @ line.N.T
        ln_J_e = numpy.log(along * across / theta**2)
        b = (along / theta)**2, (across / theta)**2  # normal, tangential
        N = numpy.broadcast_to(line.N, line.D.shape)
        D = line.D / along[:, :, None]
        zero = numpy.zeros_like(D)
        pair = lambda u, v: numpy.stack([u, v], axis=-1)  # of U, V at a node
        # gradients L_ij = d u_i / d x_j, index 0 normal and 1 tangential
        if self.round:
            over_r = N / radius[:, :, None]
            L = {(0, 0): pair(D, zero), (1, 0): pair(zero, D),
                 (0, 1): pair(-k * over_r, -over_r),
                 (1, 1): pair(over_r, k * over_r)}
        else:
            L = {(0, 0): pair(D, zero), (1, 0): pair(zero, D),
                 (0, 1): pair(-k * N, zero), (1, 1): pair(zero, k * N)}
        measure = line.weights * (line.x if self.round else 1.0)
        c2 = line.mu - line.lame_lambda * ln_J_e

        def product(weight, left, right):
            return numpy.einsum("eq,eqai,eqbj->eaibj", measure * weight, left,
                                right, optimize=True)

        trace = L[0, 0] + L[1, 1]
        K = product(line.lame_lambda, trace, trace)
        for i in range(2):
            for j in range(2):
                K = K + product(c2, L[i, j], L[j, i])
                K = K + product(line.mu * b[j], L[i, j], L[i, j])
        mass = product(1.0, pair(N, zero), pair(N, zero))
        mass = mass + product(1.0, pair(zero, N), pair(zero, N))
        K, mass = line.assemble(K), line.assemble(mass)
        held = list(self.held[0]) + [2 * (line.n - 1) + c for c in self.held[1]]
        free = numpy.setdiff1d(numpy.arange(2 * line.n), held)
        grid = numpy.ix_(free, free)
        values, vectors = eigh(K[grid], mass[grid], subset_by_index=[0, 1])
        mode = numpy.zeros(2 * line.n)
        mode[free] = vectors[:, 0]
        return values, mode.reshape(-1, 2)

    def critical(self, wave_number, begin, end, samples=12):
        """The first t at which the state is unstable, or None up to the end."""
        def smallest(t):
            return self.smallest_eigenvalue(wave_number, t)
        times = numpy.linspace(begin, end, samples)
        before = begin
        for t in times:
            if smallest(t) < 0:
                return t if t == begin else brentq(smallest, before, t,
                                                   xtol=1e-7)
            before = t
        return None


def layers(parts, **options):
    """A stack of layers between slip walls, normal is y."""
    return GrowingParts(parts, False, **options)


def rings(parts, **options):
    """Concentric rings; a first part from R = 0 is a disc."""
    return GrowingParts(parts, True, **options)


def half_space(nu=0.4, end=3.0):
    """Biot's surface instability: the theta at which a half-space that grows
    between walls loses stability against all wave numbers at once.

    The decaying solutions exp(p k y) of the incremental equations, y <= 0, leave
    the surface free of traction; the 2 x 2 determinant vanishes."""
    lame_lambda, mu = lame(1.0, nu)

    def determinant(theta):
        b1 = theta**-2
        stretch = brentq(lambda b: mu * (b**2 - 1)
                         + lame_lambda * numpy.log(b / theta), 0.2, 20)
        b2 = stretch**2
        c2 = mu - lame_lambda * numpy.log(stretch / theta)
        # (A p^2 + B p + C) (U, V) = 0 for u = (U sin x, V cos x) exp(p y)
        P, Q = lame_lambda + c2 + mu * b1, lame_lambda + c2 + mu * b2
        # rows: mu b2 p^2 - P, -(lambda + c2) p ; (lambda + c2) p, Q p^2 - mu b1
        s = lame_lambda + c2
        roots = numpy.roots([mu * b2 * Q, -(P * Q + mu * mu * b1 * b2) + s**2,
                             P * mu * b1])
        p = numpy.sqrt(roots.astype(complex))
        columns = []
        for q in p:
            U, V = s * q, mu * b2 * q**2 - P
            columns.append([-c2 * V + mu * b2 * q * U,
                            lame_lambda * (U + q * V) + (c2 + mu * b2) * q * V])
        value = numpy.linalg.det(numpy.array(columns).T)
        # freed of the factor by which the two columns become equal
        return (value / (p[0] - p[1])).real

    samples = numpy.linspace(1.05, end, 400)
    values = [determinant(theta) for theta in samples]
    for i in range(1, len(samples)):
        if values[i - 1] * values[i] < 0:
            return brentq(determinant, samples[i - 1], samples[i])
    return None
