# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Blocks in plane strain whose reference are body-fitted finite elements."""
import numpy

from tests.verification.errors import field_errors
from tests.verification.material import cauchy, lame

DEGREES = 6, 8
CONVERGED = 1e-6  # relative difference of the displacements of both degrees


def converged(make):
    """make(degree) solved with the higher degree, after a comparison with the
    lower: the reference must be much better than what it judges."""
    coarse, fine = (make(degree).solve() for degree in DEGREES)
    lengths = [axis.edges[-1] for axis in fine.axes]
    X = numpy.stack(numpy.meshgrid(*(numpy.linspace(0, l, 40)
                                     for l in lengths)), axis=-1).reshape(-1, 2)
    u = fine.evaluate(X)[0]
    difference = numpy.linalg.norm(u - coarse.evaluate(X)[0])
    if difference > CONVERGED * numpy.linalg.norm(u):
        raise RuntimeError("the finite-element reference is not converged: "
                           f"{difference / numpy.linalg.norm(u):.1e}")
    return fine


def errors(results, reference):
    """Errors of a run with Poisson's ratio 0, in 3-D between slip planes."""
    def motion(X, t):
        x = X.copy()
        x[:, :2] += reference.evaluate(X[:, :2])[0]
        return x

    def stress(X, t):
        return cauchy(reference.evaluate(X[:, :2])[1], lame(nu=0))

    return field_errors(results, motion, stress)
