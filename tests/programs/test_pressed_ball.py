# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""tests/verification/pressed_ball.py, the reference of the scene hertz.

No run of the program: the series is compared with closed forms and theorems of linear
elasticity.
"""
import numpy
import pytest
from scipy.special import roots_legendre

from tests.verification.material import lame
from tests.verification.pressed_ball import Ball, Contact, cap, force, hertz

E, NU = 1.0, 0.4
BALL = Ball(lame(E, NU))


def test_pressure_all_around():
    ball = Ball(lame(E, NU), 4)
    A, B = ball.coefficients(numpy.array([-0.3, 0, 0]), numpy.zeros(3))
    u_r, _ = ball.displacement(A, B, numpy.array([1.0]), numpy.array([0.5]))
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


@pytest.mark.parametrize("delta", [
    0.025, pytest.param(0.05, marks=pytest.mark.release)])
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
