# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""tests/verification/pressed_ball.py, the reference of the scene hertz.

No run of the program: the series is compared with finite differences, closed
forms and theorems of linear elasticity.
"""
import unittest

import numpy
from scipy.special import roots_legendre

from tests.verification.material import lame
from tests.verification.pressed_ball import (
    Ball, Contact, cap, force, hertz)

E, NU = 1.0, 0.4


class Series(unittest.TestCase):
    X = numpy.array([[0.3, 0.0, 0.4], [0.5, -0.3, 0.6], [-0.2, 0.6, -0.1]])

    def setUp(self):
        self.ball = Ball(lame(E, NU), 4)
        self.radial = numpy.array([-0.3, 0.7, 0.2])
        self.tangential = numpy.array([0.0, -0.4, 0.5])
        self.solution = self.ball.coefficients(self.radial, self.tangential)

    def displacement(self, X):
        """Cartesian."""
        r = numpy.linalg.norm(X, axis=1)
        x = X[:, 2] / r
        u_r, u_theta = self.ball.displacement(*self.solution, r, x)
        e_r = X / r[:, None]
        e_theta = ((x[:, None] * e_r - [0, 0, 1])
                   / numpy.sqrt(1 - x**2)[:, None])
        return u_r[:, None] * e_r + u_theta[:, None] * e_theta

    def stress(self, X, step=3e-4):
        gradient = derivative(self.displacement, X, step)
        strain = (gradient + numpy.swapaxes(gradient, 1, 2)) / 2
        lame_lambda, mu = lame(E, NU)
        trace = numpy.trace(strain, axis1=1, axis2=2)[:, None, None]
        return lame_lambda * trace * numpy.eye(3) + 2 * mu * strain

    def test_no_force_inside(self):
        change = derivative(self.stress, self.X, 3e-4)
        numpy.testing.assert_allclose(numpy.einsum("pijj->pi", change), 0,
                                      atol=1e-5)
        self.assertGreater(abs(change).max(), 0.1)

    def test_traction_of_the_surface(self):
        X = self.X / numpy.linalg.norm(self.X, axis=1)[:, None]
        x = X[:, 2]
        P = [1 + 0 * x, (3 * x**2 - 1) / 2, (35 * x**4 - 30 * x**2 + 3) / 8]
        sine = numpy.sqrt(1 - x**2)
        slopes = [0 * x, -3 * x * sine, -(35 * x**3 - 15 * x) / 2 * sine]
        e_theta = (x[:, None] * X - [0, 0, 1]) / sine[:, None]
        expected = ((self.radial @ P)[:, None] * X
                    + (self.tangential @ slopes)[:, None] * e_theta)
        found = numpy.einsum("pij,pj->pi", self.stress(X), X)
        numpy.testing.assert_allclose(found, expected, atol=1e-5)

    def test_pressure_all_around(self):
        A, B = self.ball.coefficients(numpy.array([-0.3, 0, 0]),
                                      numpy.zeros(3))
        u_r, _ = self.ball.displacement(A, B, numpy.array([1.0]),
                                        numpy.array([0.5]))
        self.assertAlmostEqual(u_r[0], -0.3 * (1 - 2 * NU) / E, places=14)


def derivative(function, X, step):
    """d function_i.../dx_j, the last index, by central differences."""
    return numpy.stack([(function(X + step * e) - function(X - step * e))
                        / (2 * step) for e in numpy.eye(3)], axis=-1)


class Pressed(unittest.TestCase):
    ball = Ball(lame(E, NU))

    def test_mean_strain_is_that_of_the_mean_stress(self):
        """Integrals over the surface give both, by Betti's theorem."""
        contact = Contact(self.ball, 0.3)
        x, weights = roots_legendre(1100)
        x, weights = (x + 1) / 2, weights / 2
        strain = weights @ ((contact.height(x) - x) * x)
        x, weights = cap(0.3, 100)
        stress = -weights @ (contact.pressure(x) * x)
        self.assertAlmostEqual(strain / (stress / E), 1, places=8)

    def test_the_surface_lies_on_the_plane_and_not_beyond(self):
        b = 0.25
        for layer in (0, 2e-3):
            contact = Contact(self.ball, b, layer)
            x = numpy.cos(b * numpy.linspace(0, 1, 41))
            depth = contact.height(x) - (1 - contact.delta)
            numpy.testing.assert_allclose(depth, layer * contact.pressure(x),
                                          atol=1e-3 * contact.delta)
            self.assertTrue((contact.pressure(x[:-1]) > 0).all())
            x = numpy.cos(numpy.linspace(1.02 * b, 1.5, 40))
            self.assertTrue((contact.height(x) < 1 - contact.delta).all())
            self.assertTrue((contact.pressure(x) == 0).all())

    def test_the_work_of_the_planes_is_the_energy(self):
        """dU = F d delta for each half, with U = integral of p w/2, where w is
        how far a point moves, in the layer too."""
        for layer in (0, 2e-3):
            found = []
            for b in (0.2, 0.21):
                contact = Contact(self.ball, b, layer)
                x, weights = cap(b, 100)
                way = contact.delta - (1 - x)
                energy = numpy.pi * weights @ (contact.pressure(x) * way)
                found.append((contact.delta, contact.force, energy))
            (delta, F, U), (delta_1, F_1, U_1) = found
            self.assertAlmostEqual(
                (U_1 - U) / ((F + F_1) / 2 * (delta_1 - delta)), 1, delta=2e-3)

    def test_small_contacts_are_hertz(self):
        """F/F_Hertz - 1 goes to 0 as the radius of the contact."""
        ball = Ball(lame(E, NU), 16000)
        excess = []
        for b in (0.02, 0.04):
            contact = Contact(ball, b)
            excess.append(contact.force / hertz(contact.delta, E, NU) - 1)
            self.assertAlmostEqual(b**2 / contact.delta, 1, delta=b / 2)
        self.assertLess(excess[0], 0.01)
        self.assertAlmostEqual(excess[1] / excess[0], 2, delta=0.1)

    def test_number_of_terms(self):
        for delta in (0.025, 0.05):
            few, many = (force(Ball(lame(E, NU), most), delta)
                         for most in (2000, 8000))
            self.assertAlmostEqual(few / many, 1, places=4)

    def test_a_layer_yields(self):
        """F(delta) = dU/d delta, and the layer takes layer p^2/2 from U, per
        area: of Hertz' pressure that makes 3/4 p_0 layer/delta of F."""
        delta, layer = 0.01, 1e-3
        stiff, soft = (force(self.ball, delta, value) for value in (0, layer))
        p_0 = 2 * E * delta**0.5 / (numpy.pi * (1 - NU**2))
        self.assertAlmostEqual((1 - soft / stiff) / (0.75 * p_0 * layer / delta),
                               1, delta=0.1)

