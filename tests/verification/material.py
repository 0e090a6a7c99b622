# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The compressible neo-Hookean material with growth, written independently.

Psi = lambda/2 (ln J_e)^2 + mu/2 (tr b_e - 3 - 2 ln J_e), F_e = F F_g^-1; plane
strain is F_zz = 1. Tensors are arrays (..., 3, 3), stresses in kPa.
"""
import numpy


def lame(E=1.0, nu=0.4):
    """Lame's constants (lambda, mu), kPa."""
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def embed(F):
    """A gradient in the plane as one in space, with F_zz = 1."""
    if F.shape[-1] == 3:
        return F
    space = numpy.zeros(F.shape[:-2] + (3, 3))
    space[..., :2, :2] = F
    space[..., 2, 2] = 1
    return space


def kirchhoff(F_e, constants):
    """tau = mu (b_e - I) + lambda ln J_e I."""
    lame_lambda, mu = constants
    identity = numpy.eye(3)
    b_e = F_e @ numpy.swapaxes(F_e, -1, -2)
    ln_J_e = numpy.log(numpy.linalg.det(F_e))[..., None, None]
    return mu * (b_e - identity) + lame_lambda * ln_J_e * identity


def cauchy(F, constants, growth=1.0, dim=3, per_grown_volume=False):
    """sigma = W tau / V for F_g = growth I (in the plane if dim = 2)."""
    F = embed(F)
    F_g = numpy.ones(F.shape[:-2] + (3,))
    F_g[..., :dim] = numpy.asarray(growth)[..., None]
    weight = F_g.prod(axis=-1) if per_grown_volume else 1.0
    tau = kirchhoff(F / F_g[..., None, :], constants)
    return (weight / numpy.linalg.det(F))[..., None, None] * tau
