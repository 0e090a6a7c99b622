# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth by rates against what is known of it: doc/theory.md, section 10."""
import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.signal import find_peaks

from tests.common.results import Results, read_csv

from tests.common.program import TESTS, ProgramTest

EXAMPLES = TESTS.parent / "prm/examples"

# 64 cells; exact, as no grid line passes through a cell at the start.
BOX = """
subsection Tissue
  set Shape        = box
  set Center       = 0, 0, 20
  set Size         = 40, 40, 40
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 20
end
subsection Material
  set Energy per = grown volume
end
subsection Growth
  set Law = rate
end
subsection Solver
  set Newton tolerance = 1e-10
end
subsection Output
  set Formats = csv
end
"""
HELD = {"Boundary conditions/Fixed where": "1"}
WALLS = {"Boundary conditions/Slip where": "Z < 39"}


def lame(nu, E=1.0):
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


def pressure(theta, nu=0.4):
    """Of cells grown by theta in a rigid box, per grown volume: F_e = I/theta."""
    lame_lambda, mu = lame(nu)
    tau = mu * (theta**-2 - 1) - 3 * lame_lambda * numpy.log(theta)
    return -tau * theta**3


def integrated(rate, end):
    """theta(end) if the volume grows at rate(theta)."""
    solution = solve_ivp(lambda _, y: [rate(numpy.exp(y[0] / 3))], (0, end),
                         [0.0], method="LSODA", rtol=1e-11, atol=1e-13)
    return numpy.exp(solution.y[0, -1] / 3)


def folds(surface, least):
    """How many valleys deeper than @p least (um) a grown disc has."""
    order = numpy.argsort(numpy.arctan2(surface["Y"], surface["X"]))
    radius = numpy.hypot(surface["x"], surface["y"])[order]
    valleys, _ = find_peaks(-numpy.tile(radius, 3), prominence=least)
    n = len(radius)
    return ((valleys >= n) & (valleys < 2 * n)).sum(), radius.mean()


class RateGrowth(ProgramTest):

    def grow(self, rate, step, end, name="run", nu=0.4, code=0, **keys):
        """The results of a run of the box; keys: further ones, by path."""
        scene = self.write("box.prm", BOX)
        output = self.work / name
        every = {"Growth/Rate/Rate": rate, "Time/Step": step,
                 "Time/End time": end, "Output/Interval": end,
                 "Material/Poisson's ratio": nu, **keys.pop("keys", {})}
        words = [word for path, value in every.items()
                 for word in ("-s", f"{path}={value}")]
        self.execute(scene, *words, "--replace", output=output, code=code)
        return Results(output)

    def theta(self, *arguments, **keys):
        """The same, as the ratio of lengths by which the cells have grown."""
        cells = self.grow(*arguments, **keys).last_cells()
        ratio = cells["growth_volume_ratio"]
        self.assertLess(numpy.ptp(ratio), 1e-6 * ratio.mean())
        return ratio.mean() ** (1 / 3)

    def test_rigid_box_follows_the_rate(self):
        exact = integrated(lambda x: 0.5 * max(0, 1 - pressure(x)), 1)
        self.assertAlmostEqual(exact, 1.108579, places=6)
        self.assertAlmostEqual(pressure(exact), 0.69250, places=5)
        for predictor in ("true", "false"):
            coarse, fine = (self.theta(
                "0.5*max(0, 1 - pressure/1)", step, 1,
                keys={**HELD, "Growth/Rate/Predictor": predictor})
                for step in (0.05, 0.025))
            errors = coarse - exact, fine - exact
            print("predictor", predictor, "relative errors",
                  [error / exact for error in errors])
            # With the rate of the step's beginning it is of first order.
            order = 2 if predictor == "true" else 1
            self.assertLess(abs(errors[1]), 10**(-2 - order) * exact)
            self.assertTrue(0.8 < errors[0] / errors[1] / 2**order < 1.2,
                            errors)
            self.assertAlmostEqual(
                fine + (fine - coarse) / (2**order - 1), exact,
                delta=2e-4 * exact)

    def test_rigid_box_comes_to_rest(self):
        limit = brentq(lambda x: pressure(x) - 1, 1, 1.5)
        self.assertAlmostEqual(limit, 1.145190, places=6)
        self.assertAlmostEqual(
            self.theta("0.5*max(0, 1 - pressure/1)", 0.5, 20, keys=HELD),
            limit, places=5)

    def test_nearly_incompressible_needs_the_predictor(self):
        """0.02 days is the limit of explicit steps; these are of 0.5 days."""
        one_sided, both = "0.5*max(0, 1 - pressure/1)", "0.5*(1 - pressure/1)"
        rates = {}
        for predictor in ("false", "true"):
            cells = self.grow(one_sided, 0.5, 5, nu=0.499, keys={
                **HELD, "Growth/Rate/Predictor": predictor}).last_cells()
            rates[predictor] = pressure(
                cells["growth_volume_ratio"].mean() ** (1 / 3), 0.499)
        print("pressures where 1 kPa stops growth:", rates)
        # One step far beyond, from where such a rate has no way back.
        self.assertGreater(rates["false"], 20)
        self.assertAlmostEqual(rates["true"], 1, delta=0.01)
        # A rate that may be negative grows by k dt, then withers by its excess.
        volume = self.grow(both, 0.5, 5, nu=0.499, name="swings", keys={
            **HELD, "Growth/Rate/Predictor": "false"}
        ).statistics()["grown_volume"]
        self.assertAlmostEqual(volume[1] / volume[0], numpy.exp(0.25))
        self.assertLess(volume[2] / volume[0], 1e-3)
        theta = self.theta(both, 0.5, 5, nu=0.499, name="rests", keys=HELD)
        self.assertAlmostEqual(pressure(theta, 0.499), 1, delta=0.01)

    def test_free_tissue_grows_as_without_feedback(self):
        for nu in (0.4, 0.49):
            cells = self.grow("0.5*max(0, 1 - pressure/1)", 0.25, 1,
                              nu=nu).last_cells()
            numpy.testing.assert_allclose(cells["growth_volume_ratio"],
                                          numpy.exp(0.5), rtol=1e-6)
            numpy.testing.assert_allclose(cells["elastic_volume_ratio"], 1,
                                          rtol=1e-6)

    def test_growth_along_and_across_between_walls(self):
        """As exact in later steps as in the first where at least two cells stay
        in a grid spacing and no grid line along the walls passes through one: of
        the 64 cells, as they become longer than 10 um, there are fewer than two
        in 20 um."""
        lame_lambda, mu = lame(0.4)
        for share in (0, 0.8, 1):
            along = numpy.exp(share * 0.4)
            across = numpy.exp((1 - share) * 0.4 / 2)
            stretch = brentq(
                lambda L: mu * (L**2 - 1)
                + lame_lambda * numpy.log(L / across**2), 0.5, 3)
            for step, spacing in ((1, 10), (0.25, 5)):
                results = self.grow("0.4", step, 1, keys={
                    **WALLS, "Growth/Rate/Share along": share,
                    "Growth/Rate/Direction": "0; 0; 2",
                    "Tissue/Cell spacing": spacing})
                cells = results.last_cells()
                numpy.testing.assert_allclose(
                    cells["z"], along * stretch * cells["Z"], rtol=1e-8)
                numpy.testing.assert_allclose(cells["x"], cells["X"],
                                              atol=1e-6)
                numpy.testing.assert_allclose(cells["growth_volume_ratio"],
                                              numpy.exp(0.4), rtol=1e-9)

    def test_feedback_by_volume(self):
        rate = "0.5/(1 + ((1 - J_e)/0.1)^2)"
        exact = integrated(
            lambda x: 0.5 / (1 + ((1 - x**-3) / 0.1) ** 2), 1)
        coarse, fine = (self.theta(rate, step, 1, keys=HELD)
                        for step in (0.05, 0.025))
        self.assertAlmostEqual(2 * fine - coarse, exact, delta=2e-4)
        self.assertAlmostEqual(fine, exact, delta=5e-3)

    def test_homeostasis_seeks_its_stress(self):
        keys = {**HELD, "Growth/Rate/Homeostasis": 0.2,
                "Growth/Rate/Homeostatic stress": -0.5}
        exact = integrated(lambda x: 3 * 0.2 * (0.5 - pressure(x)), 0.5)
        coarse, fine = (self.theta("0", step, 0.5, keys=keys)
                        for step in (0.05, 0.025))
        self.assertAlmostEqual(2 * fine - coarse, exact, delta=1e-3 * exact)
        limit = brentq(lambda x: pressure(x) - 0.5, 1, 1.5)
        self.assertAlmostEqual(self.theta("0", 1, 30, keys=keys), limit,
                               places=5)

    def test_homeostasis_relieves_each_direction(self):
        """Between walls in x and y, free in z: grown by a rate, relieved in the
        end, so that cells are narrower and higher, without any stress."""
        cells = self.grow("0.3*(t < 1)", 0.25, 20, keys={
            **WALLS, "Growth/Rate/Homeostasis": 1,
            "Growth/Rate/Homeostatic stress": 0}).last_cells()
        for component in ("xx", "yy", "zz", "xy", "yz", "zx"):
            numpy.testing.assert_allclose(cells["sigma_" + component], 0,
                                          atol=1e-4)
        numpy.testing.assert_allclose(cells["x"], cells["X"], atol=1e-3)
        self.assertGreater((cells["z"] / cells["Z"]).min(), 1.05)

    def test_rates_of_depth_in_the_normal_surface(self):
        """The outer cells of a free cube, of which the surface is 5 um away."""
        cells = self.grow("0.2*(depth < 12)", 0.5, 1, keys={
            "Growth/Rate/Share along": 0,
            "Growth/Rate/Direction": "surface normal"}).last_cells()
        rim = numpy.abs(numpy.stack(
            [cells["X"], cells["Y"], cells["Z"] - 20])).max(axis=0) > 9
        numpy.testing.assert_allclose(
            cells["growth_volume_ratio"], numpy.where(rim, numpy.exp(0.2), 1),
            rtol=1e-9)

    def test_cortex_folds(self):
        """The example: folds are about four layers apart."""
        output = self.work / "folds"
        self.execute(EXAMPLES / "folding-by-tangential-growth.prm",
                     "-s", "Output/Formats=csv", output=output)
        layer = 20.0
        surfaces = [read_csv(file) for file in
                    Results(output).outputs("surface")]
        flat, _ = folds(surfaces[4], 0.15 * layer)  # at 0.4 days
        self.assertEqual(flat, 0)
        n, radius = folds(surfaces[-1], 0.15 * layer)
        spacing = 2 * numpy.pi * radius / n / layer
        print(n, "folds, spacing in layers:", spacing)
        self.assertTrue(3.5 <= spacing <= 4.5, spacing)

    def test_spheroid_slows_down_under_stress(self):
        """The example, coarser: growth falls behind that of free cells, most
        where the pressure is highest."""
        output = self.work / "spheroid"
        self.execute(EXAMPLES / "growth-under-stress.prm",
                     "-s", "Tissue/Cell spacing=20", "-s", "Grid/Spacing=50",
                     "-s", "Output/Formats=csv", output=output)
        cells = Results(output).last_cells()
        R = numpy.sqrt(cells["X"]**2 + cells["Y"]**2 + cells["Z"]**2)
        ratio = cells["growth_volume_ratio"]
        numpy.testing.assert_allclose(ratio[R >= 80], 1, rtol=1e-12)
        growing = ratio[R < 80]
        print("growth", growing.min(), growing.max(), "free:", numpy.exp(2))
        self.assertGreater(growing.min(), 1.2)
        self.assertLess(growing.max(), 0.6 * numpy.exp(2))

    def test_withering_ends_the_run(self):
        result = self.grow("-40", 0.1, 1, code=2)
        self.assertTrue((result.directory / "snapshot.h5").exists())

    def test_ranks_and_resuming(self):
        keys = {"Boundary conditions/Fixed where": "Z < 1",
                "Proliferation/Law": "cell cycle"}
        rate = "0.5*max(0, 1 - pressure/1)"
        one = self.grow(rate, 0.25, 1.5, name="one", keys=keys)
        scene = self.work / "box.prm"
        words = [word for path, value in {
            **keys, "Growth/Rate/Rate": rate, "Time/Step": 0.25,
            "Output/Interval": 1.5}.items() for word in ("-s",
                                                         f"{path}={value}")]
        part = self.work / "part"
        self.execute(scene, *words, "-s", "Time/End time=0.5", output=part)
        self.execute(scene, *words, "-s", "Time/End time=1.5", "--resume",
                     output=part)
        self.assert_same_columns(one.outputs("cells")[-1],
                                 Results(part).outputs("cells")[-1])
        self.assertGreater(len(one.last_cells()), 64)

