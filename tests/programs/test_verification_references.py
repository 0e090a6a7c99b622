# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The references of the verification cases, and how ladders are judged.

No run of the program: the references are compared with published values, closed
forms and finite differences, before they judge anything.
"""
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import numpy
from scipy.integrate import trapezoid

from tests.common.results import Results
from tests.verification import layouts
from tests.verification.cases import self_weight, vortex
from tests.verification.finite_elements import Axis, Block
from tests.verification.ladder import (Ladder, Measured, ladder_case,
                                       rungs)
from tests.verification.material import cauchy, lame
from tests.verification.radial import GrowingBall, Layer
from tests.verification.report import markdown

VERIFICATION = Path(__file__).resolve().parents[1] / "verification"
SCENES = VERIFICATION.parents[1] / "prm/verification"


class Material(unittest.TestCase):
    def test_stress_is_the_derivative_of_the_energy(self):
        lame_lambda, mu = lame()
        F = numpy.array([[1.1, 0.2, 0.0], [-0.1, 0.9, 0.3], [0.05, 0.0, 1.2]])

        def energy(F):
            ln_J = numpy.log(numpy.linalg.det(F))
            return (lame_lambda / 2 * ln_J**2
                    + mu / 2 * (numpy.sum(F * F) - 3 - 2 * ln_J))

        P = numpy.empty((3, 3))
        for index in numpy.ndindex(3, 3):
            step = numpy.zeros((3, 3))
            step[index] = 1e-6
            P[index] = (energy(F + step) - energy(F - step)) / 2e-6
        numpy.testing.assert_allclose(
            cauchy(F[None], lame())[0], P @ F.T / numpy.linalg.det(F),
            atol=1e-9)


class Radial(unittest.TestCase):
    def test_published_core_and_shell(self):
        """Radii and core stresses of doc/exact-solutions.md."""
        for theta, radius, stress in ((1.1, 1.013479375, -84.3683),
                                      (1.4, 1.065731978, -225.5222)):
            ball = GrowingBall(
                [Layer(0, 0.5, lambda R, theta=theta: theta + 0 * R,
                       lambda R: 0.0),
                 Layer(0.5, 1, lambda R: 1 + 0 * R, lambda R: 0.0)],
                lame(), 3, per_grown_volume=True)
            self.assertAlmostEqual(ball.stretches(numpy.array([1.0]))[1, 0],
                                   radius, places=8)
            sigma = cauchy(ball.gradient(numpy.array([[0.2, 0.1, 0.0]])),
                           lame(), numpy.array([theta]), 3, True)
            numpy.testing.assert_allclose(1e3 * sigma[0],
                                          stress * numpy.eye(3), atol=1e-3)

    def test_equilibrium_of_graded_growth(self):
        """div P = 0 in Cartesian finite differences, free surface."""
        layer = Layer(0, 1, lambda R: 1 + 0.4 * R**2, lambda R: 0.8 * R)
        for dim in (2, 3):
            for per_grown_volume in (False, True):
                ball = GrowingBall([layer], lame(), dim, per_grown_volume)

                def piola(X):
                    F = ball.gradient(X)
                    theta = ball.stretches(numpy.linalg.norm(X, axis=1))[2]
                    sigma = cauchy(F, lame(), theta, dim,
                                   per_grown_volume)[:, :dim, :dim]
                    J = numpy.linalg.det(F)[:, None, None]
                    return J * sigma @ numpy.swapaxes(
                        numpy.linalg.inv(F), 1, 2)

                X = numpy.array([[0.3, 0.4, 0.2], [0.5, -0.6, 0.1]])[:, :dim]
                numpy.testing.assert_allclose(divergence(piola, X, 1e-4), 0,
                                              atol=1e-6)
                edge = numpy.eye(dim)[:1]
                numpy.testing.assert_allclose(piola(edge)[0, :, 0], 0,
                                              atol=1e-10)


def divergence(tensor, X, step):
    """dT_ij/dX_j by central differences."""
    total = 0
    for j in range(X.shape[1]):
        shift = step * numpy.eye(X.shape[1])[j]
        total = total + (tensor(X + shift) - tensor(X - shift))[:, :, j]
    return total / (2 * step)


class Vortex(unittest.TestCase):
    X = numpy.array([[80.0, 30.0, 1.0], [-60.0, 75.0, 2.0],
                     [10.0, -118.0, 3.0], [50.0, 20.0, 4.0]])

    def test_gradient(self):
        for j in range(3):
            shift = 1e-4 * numpy.eye(3)[j]
            column = (vortex.motion(self.X + shift, 0.5)
                      - vortex.motion(self.X - shift, 0.5)) / 2e-4
            numpy.testing.assert_allclose(
                vortex.gradient(self.X, 0.5)[:, :, j], column, atol=1e-7)

    def test_force_of_the_scenes(self):
        """The force in the .prm files balances the stress of the motion."""
        def piola(X):
            F = vortex.gradient(X, 0.5)
            return cauchy(F, lame()) @ numpy.swapaxes(numpy.linalg.inv(F), 1, 2)

        exact = -divergence(piola, self.X, 1e-3)
        for scene in ("vortex-2d.prm", "vortex-3d.prm"):
            text = (SCENES / scene).read_text().replace("\\\n", " ")
            with TemporaryDirectory() as directory:
                (Path(directory) / "parameters.prm").write_text(text)
                results = Results(directory)
            dim = results.dimension
            force = results.function("Body force/Force density", self.X, 0.5)
            numpy.testing.assert_allclose(force, exact[:, :dim], atol=1e-8)
            self.assertGreater(abs(force[0]).max(), 1e-3)


class FiniteElements(unittest.TestCase):
    def test_column_without_lateral_strain(self):
        """Poisson's ratio 0: mu (L - 1/L) carries the weight above."""
        _, mu = lame(nu=0)
        weight, height = 2e-3, 100
        block = Block((Axis([0, 10, 30], 6), Axis([0, 40, 100], 6)),
                      lame(nu=0), (0, -weight),
                      {"bottom": lambda factor: (0, 0)}).solve()
        Y = numpy.linspace(1, 99, 20)
        _, F = block.evaluate(numpy.column_stack([0 * Y + 7, Y]))
        load = -weight * (height - Y) / (2 * mu)
        exact = load + numpy.sqrt(load**2 + 1)
        numpy.testing.assert_allclose(F[:, 1, 1], exact, atol=1e-8)
        numpy.testing.assert_allclose(F[:, 0, 0], 1, atol=1e-8)

    def test_tangent(self):
        """The tangent is the derivative of the residual, for any strain."""
        block = Block((Axis([0, 2, 5], 2), Axis([0, 3], 2)), lame(),
                      held={"bottom": lambda factor: (0, 0)})
        block.prepare()
        numbers = numpy.arange(2 * block.n_nodes)
        u = 0.2 * numpy.sin(numbers)
        direction = numpy.cos(3 * numbers)
        _, K = block.assemble(u, 1)
        forward, _ = block.assemble(u + 1e-6 * direction, 1)
        backward, _ = block.assemble(u - 1e-6 * direction, 1)
        numpy.testing.assert_allclose(K @ direction,
                                      (forward - backward) / 2e-6, atol=1e-7)


class SelfWeight(unittest.TestCase):
    def test_positions_are_integrals_of_stretches(self):
        Y = numpy.linspace(0, 150, 20001)
        stretch = self_weight.stretch_at(Y, 0.7)
        X = numpy.column_stack([0 * Y, Y])
        self.assertAlmostEqual(self_weight.motion(X, 0.7)[-1, 1],
                               trapezoid(stretch, Y), places=5)


class Layouts(unittest.TestCase):
    def test_volumes_and_second_moments(self):
        for layout, volume, moment in (
                (layouts.disc, numpy.pi * 50**2, 50**2 / 2),
                (layouts.ball, 4 / 3 * numpy.pi * 50**3, 3 / 5 * 50**2)):
            X, volumes = layout(50, 2)
            self.assertAlmostEqual(volumes.sum() / volume, 1, places=12)
            mean = numpy.average((X**2).sum(axis=1), weights=volumes)
            self.assertAlmostEqual(mean / moment, 1, delta=2e-3)
            numpy.testing.assert_allclose(
                numpy.average(X, axis=0, weights=volumes), 0, atol=0.02)


class Judgement(unittest.TestCase):
    def ladder(self, **asserted):
        return Ladder("a", ("b.prm",), "h [µm]", "", rungs("c", [4, 2, 1]),
                      **asserted)

    def test_order(self):
        ladder = self.ladder(least_orders={"e": 1.9})
        sizes = numpy.array([4.0, 2.0, 1.0])
        good = Measured(ladder, sizes, {"e": 3 * sizes**2})
        self.assertAlmostEqual(good.order("e"), 2)
        self.assertTrue(all(found.holds() for found in good.findings()))
        for errors in (sizes**1.8, 0 * sizes + 1, sizes * numpy.nan,
                       [1.0, 0.1, 0.0]):
            found, = Measured(ladder, sizes, {"e": errors}).findings()
            self.assertFalse(found.holds())

    def test_largest(self):
        ladder = self.ladder(most={"e": 0.5})
        for errors, holds in (([0.5, 0.1], True), ([0.1, 0.6], False),
                              ([0.1, float("nan")], False)):
            found, = Measured(ladder, [2, 1], {"e": errors}).findings()
            self.assertEqual(found.holds(), holds)

    def test_the_page_says_what_is_not_met(self):
        ladder = self.ladder(most={"e": 0.5})
        for errors, told in (([0.5, 0.1], 0), ([0.1, 0.6], 1)):
            measured = Measured(ladder, [2, 1], {"e": errors})
            page = markdown([measured], measured.findings(), True)
            self.assertEqual(page.count("**Not met:** a: e is 0.6, not at most "
                                        "0.5"), told)
            self.assertEqual(page.count("Not met"), told)

    def test_a_case_of_ladders(self):
        """Its trials are the rungs, ctest's and those of the full size; errors
        come from the runs of a rung."""
        ladder = Ladder("a", ("b.prm", "c.prm"), "h [µm]", "one step",
                        rungs("c", [4, 2, 1], full_only=[1],
                              cells=lambda h: lambda: layouts.disc(50, 10)),
                        most={"e": 0.5})
        case = ladder_case("t", "r", [ladder], lambda b, c: {"e": b - c})
        self.assertEqual([trial.name for trial in case.wanted(False)],
                         ["a/4/b", "a/4/c", "a/2/b", "a/2/c"])
        self.assertEqual(len(case.wanted(True)), 6)
        text = case.trials[0].files["cells.csv"]()
        self.assertTrue(text.startswith("x,y,volume\n"))
        runs = {trial.name: SimpleNamespace(results=float(i))
                for i, trial in enumerate(case.wanted(False))}
        measured, = case.measure(runs)
        self.assertEqual((measured.sizes, measured.errors),
                         ([4, 2], {"e": [-1.0, -1.0]}))
        found = list(case.judge([measured]))
        self.assertEqual(case.unfounded(found), [])
        self.assertEqual(case.unfounded([]), case.sentences())

    def test_a_ladder_asserts_something(self):
        with self.assertRaises(ValueError):
            self.ladder()

