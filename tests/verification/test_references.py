# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The references of verification, without a run of the program: they are compared
with published values, closed forms and finite differences, before they judge
anything."""
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy
import pytest
from scipy.integrate import trapezoid

from tests.common.cases import Case, Table, assert_finite
from tests.common.results import Results
from tests.verification import layouts, test_self_weight, test_vortex
from tests.verification.finite_elements import Axis, Block
from tests.verification.ladder import order
from tests.verification.material import cauchy, lame
from tests.verification.radial import GrowingBall, Layer

pytestmark = pytest.mark.quick

SCENES = Path(__file__).resolve().parents[2] / "prm/verification"


def divergence(tensor, X, step):
    """dT_ij/dX_j by central differences."""
    return sum((tensor(X + shift) - tensor(X - shift))[:, :, j] / (2 * step)
               for j, shift in enumerate(step * numpy.eye(X.shape[1])))


def test_stress_is_the_derivative_of_the_energy():
    lame_lambda, mu = lame()
    F = numpy.array([[1.1, 0.2, 0.0], [-0.1, 0.9, 0.3], [0.05, 0.0, 1.2]])

    def energy(F):
        ln_J = numpy.log(numpy.linalg.det(F))
        return lame_lambda / 2 * ln_J**2 + mu / 2 * (numpy.sum(F * F) - 3 - 2 * ln_J)

    P = numpy.empty((3, 3))
    for index in numpy.ndindex(3, 3):
        step = numpy.zeros((3, 3))
        step[index] = 1e-6
        P[index] = (energy(F + step) - energy(F - step)) / 2e-6
    numpy.testing.assert_allclose(cauchy(F[None], lame())[0],
                                  P @ F.T / numpy.linalg.det(F), atol=1e-9)


@pytest.mark.parametrize("theta, radius, stress", [
    (1.1, 1.013479375, -84.3683), (1.4, 1.065731978, -225.5222)])
def test_core_and_shell(theta, radius, stress):
    """Radii and core stresses of doc/exact-solutions.md."""
    ball = GrowingBall(
        [Layer(0, 0.5, lambda R: theta + 0 * R, lambda R: 0.0),
         Layer(0.5, 1, lambda R: 1 + 0 * R, lambda R: 0.0)],
        lame(), 3, per_grown_volume=True)
    assert abs(ball.stretches(numpy.array([1.0]))[1, 0] - radius) < 5e-9
    sigma = cauchy(ball.gradient(numpy.array([[0.2, 0.1, 0.0]])), lame(),
                   numpy.array([theta]), 3, True)
    numpy.testing.assert_allclose(1e3 * sigma[0], stress * numpy.eye(3), atol=1e-3)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("per_grown_volume", [False, True])
def test_equilibrium_of_graded_growth(dim, per_grown_volume):
    """div P = 0 in Cartesian finite differences, free surface."""
    layer = Layer(0, 1, lambda R: 1 + 0.4 * R**2, lambda R: 0.8 * R)
    ball = GrowingBall([layer], lame(), dim, per_grown_volume)

    def piola(X):
        F = ball.gradient(X)
        theta = ball.stretches(numpy.linalg.norm(X, axis=1))[2]
        sigma = cauchy(F, lame(), theta, dim, per_grown_volume)[:, :dim, :dim]
        J = numpy.linalg.det(F)[:, None, None]
        return J * sigma @ numpy.swapaxes(numpy.linalg.inv(F), 1, 2)

    X = numpy.array([[0.3, 0.4, 0.2], [0.5, -0.6, 0.1]])[:, :dim]
    numpy.testing.assert_allclose(divergence(piola, X, 1e-4), 0, atol=1e-6)
    numpy.testing.assert_allclose(piola(numpy.eye(dim)[:1])[0, :, 0], 0, atol=1e-10)


RING = numpy.array([[80.0, 30.0, 1.0], [-60.0, 75.0, 2.0], [10.0, -118.0, 3.0],
                    [50.0, 20.0, 4.0]])


def test_gradient_of_the_vortex():
    for j, shift in enumerate(1e-4 * numpy.eye(3)):
        column = (test_vortex.motion(RING + shift, 0.5)
                  - test_vortex.motion(RING - shift, 0.5)) / 2e-4
        numpy.testing.assert_allclose(test_vortex.gradient(RING, 0.5)[:, :, j], column,
                                      atol=1e-7)


@pytest.mark.parametrize("dim", [2, 3])
def test_force_of_the_vortex(tmp_path, dim):
    """The force in the .prm files balances the stress of the motion."""
    def piola(X):
        F = test_vortex.gradient(X, 0.5)
        return cauchy(F, lame()) @ numpy.swapaxes(numpy.linalg.inv(F), 1, 2)

    exact = -divergence(piola, RING, 1e-3)
    shutil.copy(SCENES / f"vortex-{dim}d.prm", tmp_path / "parameters.prm")
    (tmp_path / "statistics.csv").touch()
    force = Results(tmp_path).function("Body force/Force density", RING, 0.5)
    numpy.testing.assert_allclose(force, exact[:, :dim], atol=1e-8)
    assert abs(force[0]).max() > 1e-3


def test_finite_elements_of_a_column():
    """Without lateral strain, Poisson's ratio 0: mu (L - 1/L) carries the weight
    above."""
    _, mu = lame(nu=0)
    weight, height = 2e-3, 100
    block = Block((Axis([0, 10, 30], 6), Axis([0, 40, 100], 6)), lame(nu=0),
                  (0, -weight), {"bottom": lambda factor: (0, 0)}).solve()
    Y = numpy.linspace(1, 99, 20)
    _, F = block.evaluate(numpy.column_stack([0 * Y + 7, Y]))
    load = -weight * (height - Y) / (2 * mu)
    numpy.testing.assert_allclose(F[:, 1, 1], load + numpy.sqrt(load**2 + 1), atol=1e-8)
    numpy.testing.assert_allclose(F[:, 0, 0], 1, atol=1e-8)


def test_tangent_of_finite_elements():
    """It is the derivative of the residual, for any strain."""
    block = Block((Axis([0, 2, 5], 2), Axis([0, 3], 2)), lame(),
                  held={"bottom": lambda factor: (0, 0)})
    block.prepare()
    numbers = numpy.arange(2 * block.n_nodes)
    u, direction = 0.2 * numpy.sin(numbers), numpy.cos(3 * numbers)
    _, K = block.assemble(u, 1)
    forward, _ = block.assemble(u + 1e-6 * direction, 1)
    backward, _ = block.assemble(u - 1e-6 * direction, 1)
    numpy.testing.assert_allclose(K @ direction, (forward - backward) / 2e-6, atol=1e-7)


def test_positions_under_self_weight_are_integrals_of_stretches():
    Y = numpy.linspace(0, 150, 20001)
    stretch = test_self_weight.stretch_at(Y, 0.7)
    X = numpy.column_stack([0 * Y, Y])
    assert abs(test_self_weight.motion(X, 0.7)[-1, 1] - trapezoid(stretch, Y)) < 5e-6


@pytest.mark.parametrize("layout, volume, moment", [
    (layouts.disc, numpy.pi * 50**2, 50**2 / 2),
    (layouts.ball, 4 / 3 * numpy.pi * 50**3, 3 / 5 * 50**2)])
def test_layouts(layout, volume, moment):
    X, volumes = layout(50, 2)
    assert abs(volumes.sum() / volume - 1) < 5e-13
    mean = numpy.average((X**2).sum(axis=1), weights=volumes)
    assert abs(mean / moment - 1) < 2e-3
    numpy.testing.assert_allclose(numpy.average(X, axis=0, weights=volumes), 0, atol=0.02)


def test_order():
    sizes = numpy.array([4.0, 2.0, 1.0])
    assert abs(order(sizes, 3 * sizes**2) - 2) < 1e-7
    for errors in (0 * sizes, sizes * numpy.nan, [1.0, 0.1, 0.0]):
        assert numpy.isnan(order(sizes, errors))


@pytest.mark.parametrize("value, limits", [
    (1.2, {"at_most": 1}), (0.8, {"at_least": 1}), (1, {"equals": (1.1, 0.05)}),
    (numpy.nan, {"at_most": 1}), (1, {})])
def test_figures_outside_of_their_limits_fail(value, limits):
    case = SimpleNamespace(table=Table())
    Case.found(case, "right", 1, at_least=1, at_most=1)
    with pytest.raises(AssertionError):
        Case.found(case, "wrong", value, **limits)


@pytest.mark.parametrize("number", ["nan", "-nan", "inf", "NaN"])
def test_numbers_that_are_none_are_found(tmp_path, number):
    file = tmp_path / "statistics.csv"
    file.write_text("nan,banana\n1,2\n")
    assert_finite(tmp_path)
    file.write_text(f"step,time\n1,2\n2,{number}\n")
    with pytest.raises(AssertionError):
        assert_finite(tmp_path)
