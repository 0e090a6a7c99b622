# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""tests/verification/pressed_ball.py, the reference of the scene hertz.

No run of the program: the series is compared with finite differences, closed
forms and theorems of linear elasticity.
"""
import numpy
import pytest
from scipy.special import eval_legendre, roots_legendre

from tests.verification.material import lame
from tests.verification.pressed_ball import Ball, Contact, cap, force, hertz

E, NU = 1.0, 0.4
POINTS = numpy.array([[0.3, 0.0, 0.4], [0.5, -0.3, 0.6], [-0.2, 0.6, -0.1]])
RADIAL, TANGENTIAL = numpy.array([-0.3, 0.7, 0.2]), numpy.array([0.0, -0.4, 0.5])
BALL = Ball(lame(E, NU))
FEW = Ball(lame(E, NU), 4)
SOLUTION = FEW.coefficients(RADIAL, TANGENTIAL)


def along_meridian(X):
    """The cosine of the polar angle, and the unit vectors, radial and to the south."""
    r = numpy.linalg.norm(X, axis=1)
    x = X[:, 2] / r
    e_r = X / r[:, None]
    return r, x, e_r, (x[:, None] * e_r - [0, 0, 1]) / numpy.sqrt(1 - x**2)[:, None]


def displacement(X):
    """Cartesian."""
    r, x, e_r, e_theta = along_meridian(X)
    u_r, u_theta = FEW.displacement(*SOLUTION, r, x)
    return u_r[:, None] * e_r + u_theta[:, None] * e_theta


def derivative(function, X, step=3e-4):
    """d function_i.../dx_j, the last index, by central differences."""
    return numpy.stack([(function(X + step * e) - function(X - step * e)) / (2 * step)
                        for e in numpy.eye(3)], axis=-1)


def stress(X):
    gradient = derivative(displacement, X)
    strain = (gradient + numpy.swapaxes(gradient, 1, 2)) / 2
    lame_lambda, mu = lame(E, NU)
    trace = numpy.trace(strain, axis1=1, axis2=2)[:, None, None]
    return lame_lambda * trace * numpy.eye(3) + 2 * mu * strain


def test_no_force_inside():
    change = derivative(stress, POINTS)
    numpy.testing.assert_allclose(numpy.einsum("pijj->pi", change), 0, atol=1e-5)
    assert abs(change).max() > 0.1


def test_traction_of_the_surface():
    X = POINTS / numpy.linalg.norm(POINTS, axis=1)[:, None]
    _, x, e_r, e_theta = along_meridian(X)
    P = eval_legendre([[0], [2], [4]], x)
    sine = numpy.sqrt(1 - x**2)
    slopes = [0 * x, -3 * x * sine, -(35 * x**3 - 15 * x) / 2 * sine]
    expected = (RADIAL @ P)[:, None] * e_r + (TANGENTIAL @ slopes)[:, None] * e_theta
    found = numpy.einsum("pij,pj->pi", stress(X), X)
    numpy.testing.assert_allclose(found, expected, atol=1e-5)


def test_pressure_all_around():
    A, B = FEW.coefficients(numpy.array([-0.3, 0, 0]), numpy.zeros(3))
    u_r, _ = FEW.displacement(A, B, numpy.array([1.0]), numpy.array([0.5]))
    assert abs(u_r[0] + 0.3 * (1 - 2 * NU) / E) <= 5e-15


def test_mean_strain_is_that_of_the_mean_stress():
    """Integrals over the surface give both, by Betti's theorem."""
    contact = Contact(BALL, 0.3)
    x, weights = roots_legendre(1100)
    x, weights = (x + 1) / 2, weights / 2
    strain = weights @ ((contact.height(x) - x) * x)
    x, weights = cap(0.3, 100)
    mean_stress = -weights @ (contact.pressure(x) * x)
    assert abs(strain / (mean_stress / E) - 1) <= 5e-9


@pytest.mark.parametrize("layer", [0, 2e-3])
def test_the_surface_lies_on_the_plane_and_not_beyond(layer):
    b = 0.25
    contact = Contact(BALL, b, layer)
    x = numpy.cos(b * numpy.linspace(0, 1, 41))
    depth = contact.height(x) - (1 - contact.delta)
    numpy.testing.assert_allclose(depth, layer * contact.pressure(x), atol=1e-3 * contact.delta)
    assert (contact.pressure(x[:-1]) > 0).all()
    x = numpy.cos(numpy.linspace(1.02 * b, 1.5, 40))
    assert (contact.height(x) < 1 - contact.delta).all()
    assert (contact.pressure(x) == 0).all()


@pytest.mark.parametrize("layer", [0, 2e-3])
def test_the_work_of_the_planes_is_the_energy(layer):
    """dU = F d delta for each half, with U = integral of p w/2, where w is
    how far a point moves, in the layer too."""
    found = []
    for b in (0.2, 0.21):
        contact = Contact(BALL, b, layer)
        x, weights = cap(b, 100)
        way = contact.delta - (1 - x)
        found.append((contact.delta, contact.force,
                      numpy.pi * weights @ (contact.pressure(x) * way)))
    (delta, F, U), (delta_1, F_1, U_1) = found
    assert abs((U_1 - U) / ((F + F_1) / 2 * (delta_1 - delta)) - 1) <= 2e-3


def test_small_contacts_are_hertz():
    """F/F_Hertz - 1 goes to 0 as the radius of the contact."""
    ball = Ball(lame(E, NU), 16000)
    excess = []
    for b in (0.02, 0.04):
        contact = Contact(ball, b)
        excess.append(contact.force / hertz(contact.delta, E, NU) - 1)
        assert abs(b**2 / contact.delta - 1) <= b / 2
    assert excess[0] < 0.01
    assert abs(excess[1] / excess[0] - 2) <= 0.1


@pytest.mark.parametrize("delta", [0.025, 0.05])
def test_number_of_terms(delta):
    few, many = (force(Ball(lame(E, NU), most), delta) for most in (2000, 8000))
    assert abs(few / many - 1) <= 5e-5


def test_a_layer_yields():
    """F(delta) = dU/d delta, and the layer takes layer p^2/2 from U, per
    area: of Hertz' pressure that makes 3/4 p_0 layer/delta of F."""
    delta, layer = 0.01, 1e-3
    stiff, soft = (force(BALL, delta, value) for value in (0, layer))
    p_0 = 2 * E * delta**0.5 / (numpy.pi * (1 - NU**2))
    assert abs((1 - soft / stiff) / (0.75 * p_0 * layer / delta) - 1) <= 0.1
