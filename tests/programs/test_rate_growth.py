# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth by rates against what is known of it: doc/theory.md, section 10."""
import numpy
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.signal import find_peaks

from tests.common.program import TESTS
from tests.verification.material import lame

EXAMPLES = TESTS.parent / "prm/examples"
BOX = {"Tissue/Shape": "box", "Tissue/Center": "0, 0, 20", "Tissue/Size": "40, 40, 40",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 20,
       "Growth/Law": "rate", "Solver/Newton tolerance": 1e-10, "Output/Formats": "csv"}
HELD = {"Boundary conditions/Fixed where": 1}
WALLS = {"Boundary conditions/Slip where": "Z < 39"}
ONE_SIDED, BOTH = "0.5*max(0, 1 - pressure/1)", "0.5*(1 - pressure/1)"


def pressure(theta, nu=0.4):
    """Of cells grown by theta in a rigid box, per grown volume: F_e = I/theta."""
    lame_lambda, mu = lame(1, nu)
    tau = mu * (theta**-2 - 1) - 3 * lame_lambda * numpy.log(theta)
    return -tau * theta**3


def integrated(rate, end):
    """theta(end) if the volume grows at rate(theta)."""
    solution = solve_ivp(lambda _, y: [rate(numpy.exp(y[0] / 3))], (0, end), [0.0],
                         method="LSODA", rtol=1e-11, atol=1e-13)
    return numpy.exp(solution.y[0, -1] / 3)


def grow(runs, rate, step, end, keys, nu=0.4, **options):
    """A run of the box."""
    return runs.run("box", BOX, {"Growth/Rate/Rate": rate, "Time/Step": step,
                                 "Time/End time": end, "Output/Interval": end,
                                 "Material/Poisson's ratio": nu, **keys}, **options)


def theta(*arguments, **options):
    """The ratio of lengths by which the cells have grown."""
    ratio = grow(*arguments, **options).cells(-1)["growth_volume_ratio"]
    assert numpy.ptp(ratio) < 1e-6 * ratio.mean()
    return ratio.mean() ** (1 / 3)


# With the rate of the step's beginning it is of first order.
@pytest.mark.parametrize("predictor, order", [("true", 2), ("false", 1)])
def test_rigid_box_follows_the_rate(runs, predictor, order):
    exact = integrated(lambda x: 0.5 * max(0, 1 - pressure(x)), 1)
    assert abs(exact - 1.108579) <= 5e-7
    assert abs(pressure(exact) - 0.69250) <= 5e-6
    coarse, fine = (theta(runs, ONE_SIDED, step, 1, {**HELD, "Growth/Rate/Predictor": predictor})
                    for step in (0.05, 0.025))
    assert abs(fine - exact) < 10**(-2 - order) * exact
    assert 0.8 < (coarse - exact) / (fine - exact) / 2**order < 1.2
    assert abs(fine + (fine - coarse) / (2**order - 1) - exact) <= 2e-4 * exact


def test_rigid_box_comes_to_rest(runs):
    limit = brentq(lambda x: pressure(x) - 1, 1, 1.5)
    assert abs(limit - 1.145190) <= 5e-7
    assert abs(theta(runs, ONE_SIDED, 0.5, 20, HELD) - limit) <= 5e-6


def test_nearly_incompressible_needs_the_predictor(runs):
    """0.02 days is the limit of explicit steps; these are of 0.5 days."""
    explicit = {**HELD, "Growth/Rate/Predictor": "false"}
    far, right = (pressure(grow(runs, ONE_SIDED, 0.5, 5, keys, nu=0.499)
                           .cells(-1)["growth_volume_ratio"].mean() ** (1 / 3), 0.499)
                  for keys in (explicit, HELD))
    # One step far beyond, from where such a rate has no way back.
    assert far > 20
    assert abs(right - 1) <= 0.01
    # A rate that may be negative grows by k dt, then withers by its excess.
    volume = grow(runs, BOTH, 0.5, 5, explicit, nu=0.499).statistics["grown_volume"]
    assert abs(volume[1] / volume[0] - numpy.exp(0.25)) <= 5e-8
    assert volume[2] / volume[0] < 1e-3
    assert abs(pressure(theta(runs, BOTH, 0.5, 5, HELD, nu=0.499), 0.499) - 1) <= 0.01


@pytest.mark.parametrize("nu", [0.4, 0.49])
def test_free_tissue_grows_as_without_feedback(runs, nu):
    cells = grow(runs, ONE_SIDED, 0.25, 1, {}, nu=nu).cells(-1)
    numpy.testing.assert_allclose(cells["growth_volume_ratio"], numpy.exp(0.5), rtol=1e-6)
    numpy.testing.assert_allclose(cells["elastic_volume_ratio"], 1, rtol=1e-6)


@pytest.mark.parametrize("share", [0, 0.8, 1])
@pytest.mark.parametrize("step, spacing", [(1, 10), (0.25, 5)])
def test_growth_along_and_across_between_walls(runs, share, step, spacing):
    """As exact in later steps as in the first where at least two cells stay
    in a grid spacing and no grid line along the walls passes through one: of
    the 64 cells, as they become longer than 10 um, there are fewer than two
    in 20 um."""
    lame_lambda, mu = lame(1, 0.4)
    along, across = numpy.exp(share * 0.4), numpy.exp((1 - share) * 0.4 / 2)
    stretch = brentq(lambda L: mu * (L**2 - 1) + lame_lambda * numpy.log(L / across**2), 0.5, 3)
    cells = grow(runs, "0.4", step, 1, {
        **WALLS, "Growth/Rate/Share along": share, "Growth/Rate/Direction": "0; 0; 2",
        "Tissue/Cell spacing": spacing}).cells(-1)
    numpy.testing.assert_allclose(cells["z"], along * stretch * cells["Z"], rtol=1e-8)
    numpy.testing.assert_allclose(cells["x"], cells["X"], atol=1e-6)
    numpy.testing.assert_allclose(cells["growth_volume_ratio"], numpy.exp(0.4), rtol=1e-9)


def test_feedback_by_volume(runs):
    exact = integrated(lambda x: 0.5 / (1 + ((1 - x**-3) / 0.1) ** 2), 1)
    coarse, fine = (theta(runs, "0.5/(1 + ((1 - J_e)/0.1)^2)", step, 1, HELD)
                    for step in (0.05, 0.025))
    assert abs(2 * fine - coarse - exact) <= 2e-4
    assert abs(fine - exact) <= 5e-3


def test_homeostasis_seeks_its_stress(runs):
    keys = {**HELD, "Growth/Rate/Homeostasis": 0.2, "Growth/Rate/Homeostatic stress": -0.5}
    exact = integrated(lambda x: 3 * 0.2 * (0.5 - pressure(x)), 0.5)
    coarse, fine = (theta(runs, "0", step, 0.5, keys) for step in (0.05, 0.025))
    assert abs(2 * fine - coarse - exact) <= 1e-3 * exact
    limit = brentq(lambda x: pressure(x) - 0.5, 1, 1.5)
    assert abs(theta(runs, "0", 1, 30, keys) - limit) <= 5e-6


def test_homeostasis_relieves_each_direction(runs):
    """Between walls in x and y, free in z: grown by a rate, relieved in the
    end, so that cells are narrower and higher, without any stress."""
    cells = grow(runs, "0.3*(t < 1)", 0.25, 20, {
        **WALLS, "Growth/Rate/Homeostasis": 1, "Growth/Rate/Homeostatic stress": 0}).cells(-1)
    assert abs(cells.filter(like="sigma_")).max().max() <= 1e-4
    numpy.testing.assert_allclose(cells["x"], cells["X"], atol=1e-3)
    assert (cells["z"] / cells["Z"]).min() > 1.05


def test_rates_of_depth_in_the_normal_surface(runs):
    """The outer cells of a free cube, of which the surface is 5 um away."""
    cells = grow(runs, "0.2*(depth < 12)", 0.5, 1, {
        "Growth/Rate/Share along": 0, "Growth/Rate/Direction": "surface normal"}).cells(-1)
    rim = abs(cells[["X", "Y", "Z"]] - [0, 0, 20]).max(axis=1) > 9
    numpy.testing.assert_allclose(cells["growth_volume_ratio"],
                                  numpy.where(rim, numpy.exp(0.2), 1), rtol=1e-9)


def folds(surface, least):
    """How many valleys deeper than @p least (um) a grown disc has, and its radius."""
    order = numpy.argsort(numpy.arctan2(surface["Y"], surface["X"]))
    radius = numpy.hypot(surface["x"], surface["y"]).to_numpy()[order]
    valleys, _ = find_peaks(-numpy.tile(radius, 3), prominence=least)
    n = len(radius)
    return ((valleys >= n) & (valleys < 2 * n)).sum(), radius.mean()


@pytest.mark.release
def test_cortex_folds(runs):
    """The example: folds are about four layers apart."""
    run = runs.run("folds", EXAMPLES / "folding-by-tangential-growth.prm",
                   {"Output/Formats": "csv"})
    layer = 20.0
    assert folds(run.surface(4), 0.15 * layer)[0] == 0  # at 0.4 days
    n, radius = folds(run.surface(-1), 0.15 * layer)
    assert 3.5 <= 2 * numpy.pi * radius / n / layer <= 4.5


def test_spheroid_slows_down_under_stress(runs):
    """The example, coarser: growth falls behind that of free cells, most
    where the pressure is highest."""
    cells = runs.run("spheroid", EXAMPLES / "growth-under-stress.prm", {
        "Tissue/Cell spacing": 20, "Grid/Spacing": 50, "Output/Formats": "csv"}).cells(-1)
    R = numpy.linalg.norm(cells[["X", "Y", "Z"]], axis=1)
    ratio = cells["growth_volume_ratio"]
    numpy.testing.assert_allclose(ratio[R >= 80], 1, rtol=1e-12)
    assert ratio[R < 80].min() > 1.2
    assert ratio[R < 80].max() < 0.6 * numpy.exp(2)


def test_withering_ends_the_run(runs):
    run = runs.run("withers", BOX, {"Growth/Rate/Rate": -40, "Time/Step": 0.1}, code=2)
    assert (run.directory / "snapshot.h5").exists()
