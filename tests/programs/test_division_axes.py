# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Along which axes cells divide. Two daughters are born along their mother's axis,
the second where it points: lineage.csv tells all axes of a run."""
import numpy
from tests.common.program import SCENES, ProgramTest, overrides, read_csv
from scipy.spatial import KDTree

from tests.common.results import Results, positions, stresses

CYCLE = "Proliferation/Cell cycle/"

# All cells enter S at t = 0 and divide at the end of the only step.
TOGETHER = """
subsection Time
  set End time = 0.5
  set Step     = 0.5
end
subsection Proliferation
  set Law = cell cycle
  subsection Cell cycle
    set Start = together
  end
end
subsection Output
  set Formats  = csv
  set Interval = 0
end
"""

BLOCK = TOGETHER + """
subsection Tissue
  set Shape        = box
  set Size         = 100, 100, 100
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 50
end
"""

BALL = TOGETHER + """
subsection Tissue
  set Radius       = 60
  set Center       = 100, 0, 0
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 50
end
subsection Boundary conditions
  set Fixed where = 1
end
"""

# A slab in plane strain that is stretched by a tenth in the first step, in a
# frame of the same shape. Cells wait for that: the checkpoint lets them go where
# the second step begins, all at once.
SLAB = """
set Dimension = 2
set Method = paper
subsection Time
  set End time = 1.1
  set Step     = 0.1
end
subsection Tissue
  set Shape        = box
  set Size         = 160, 80
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 20
end
subsection Material
  set Energy per = grown volume
end
subsection Proliferation
  set Law = cell cycle
  subsection Cell cycle
    set Start           = together
    set Size checkpoint = 1.0999
  end
end
subsection Boundary conditions
  set Fixed where  = 1
  set Displacement = 0.1*X*min(t/0.1, 1); 0
end
subsection Solver
  set Newton tolerance = 1e-8
end
subsection Output
  set Formats  = csv
  set Interval = 0.1
end
"""


def axes(lineage):
    """Founders' numbers and the unit vectors along which they divided."""
    born = lineage[lineage["generation"] == 1]
    first, second = born[0::2], born[1::2]
    assert (first["parent"] == second["parent"]).all()
    n = positions(second) - positions(first)
    return first["parent"].astype(int), n / numpy.linalg.norm(
        n, axis=1)[:, None]


def chi_squared(values, bins):
    """Of values that ought to be uniform in [0, 1]."""
    counts = numpy.histogram(values, bins, (0.0, 1.0))[0]
    expected = len(values) / bins
    return ((counts - expected)**2 / expected).sum()


class DivisionAxes(ProgramTest):
    def run_scene(self, name, text, keys, ranks=1):
        output = self.work / name
        self.execute(self.write("scene.prm", text), *overrides(keys),
                     output=output, ranks=ranks)
        return Results(output)

    def axes_of(self, name, text, keys, ranks=1):
        results = self.run_scene(name, text, {
            CYCLE + key: value for key, value in keys.items()}, ranks)
        lineage = results.lineage()
        mothers, n = axes(lineage)
        founders = lineage[lineage["generation"] == 0]
        self.assertEqual(len(n), len(founders))
        return n, positions(founders)[mothers]

    def test_spread(self):
        """The angles to the axis have the distribution that the scene asks for,
        and not another one."""
        n, _ = self.axes_of("spread", BLOCK, {
            "Division axis": "fixed", "Fixed axis": "1; 2; 2",
            "Axis spread": "4"})
        self.assertEqual(len(n), 1000)
        cosine = n @ (numpy.array([1, 2, 2]) / 3)

        def judged(kappa):
            return chi_squared(numpy.expm1(-kappa * (1 - cosine))
                               / numpy.expm1(-2 * kappa), 10)
        # 9 degrees of freedom: above with probability 0.001
        self.assertLess(judged(4), 27.88)
        self.assertGreater(judged(6), 27.88)
        self.assertGreater(judged(2.7), 27.88)

    def test_no_spread(self):
        n, _ = self.axes_of("fixed", BLOCK, {
            "Division axis": "fixed", "Fixed axis": "1, 2, 2"})
        self.assertLess(abs(n - numpy.array([1, 2, 2]) / 3).max(), 1e-8)
        n, X = self.axes_of("by place", BLOCK, {
            "Division axis": "fixed", "Fixed axis": "X > 0; X <= 0; 0"})
        right = X[:, 0] > 0
        self.assertLess(abs(n[right] - [1, 0, 0]).max(), 1e-8)
        self.assertLess(abs(n[~right] - [0, 1, 0]).max(), 1e-8)

    def test_by_the_surface(self):
        """On a sphere: radially, along its normals, tangentially. The
        boundary points are 10 um apart, the normals as coarse."""
        n, X = self.axes_of("radial", BALL, {
            "Division axis": "radial", "Radial center": "100; 0; 0"})
        outward = X - [100, 0, 0]
        distance = numpy.linalg.norm(outward, axis=1)
        outward /= distance[:, None]
        self.assertGreater((n * outward).sum(axis=1).min(), 1 - 1e-4)

        # near the middle all of the surface is as near
        outer = distance > 30
        self.assertGreater(outer.sum(), 500)
        n, _ = self.axes_of("normal", BALL, {"Division axis": "surface normal"})
        self.assertGreater((n * outward).sum(axis=1)[outer].min(), 0.97)

        n, _ = self.axes_of("tangential", BALL, {"Division axis": "tangential"})
        self.assertLess(abs((n * outward).sum(axis=1)[outer]).max(), 0.25)
        # any way round: the angle to the parallel is uniform
        east = numpy.cross([0, 0, 1], outward)
        north = numpy.cross(outward, east)
        turn = numpy.arctan2((n * north).sum(axis=1), (n * east).sum(axis=1))
        self.assertLess(chi_squared(0.5 + 0.5 * turn[outer] / numpy.pi, 10),
                        27.88)

    def differences(self, axis, **keys):
        """Mean of sigma_xx - sigma_yy over the slab, at each output, and the
        results."""
        results = self.run_scene(axis, SLAB, {
            CYCLE + "Division axis": axis.split()[0], **{
                CYCLE + key.replace("_", " "): value
                for key, value in keys.items()}})
        means = []
        for file in results.outputs("cells"):
            cells = read_csv(file)
            sigma = stresses(cells)
            means.append(numpy.average(sigma[:, 0, 0] - sigma[:, 1, 1],
                                       weights=cells["volume"]))
        return numpy.array(means), results

    def test_stretched_slab(self):
        """Divisions along the stretch take the tension away, those at random do
        not. The frame keeps F = diag(1.1, 1); with F_g = I + (theta - 1) n n and
        b_e = F F_g^-2 F the difference is mu (b_xx - b_yy) theta / 1.1,
        doc/theory.md (6.3f)."""
        stretch, results = self.differences("stretch")
        random, _ = self.differences("random")
        along, _ = self.differences("fixed along", Fixed_axis="1; 0")
        across, _ = self.differences("fixed across", Fixed_axis="0; 1")
        _, mu = results.lame()
        # theta at the outputs from t = 0.1 on: J_e is 1 + t until then, and
        # passes the checkpoint at 0.0999, a ten thousandth before
        theta = 1 + 0.1 * numpy.arange(11)
        weight = mu * theta / 1.1
        for name, means, exact in [
                ("stretch", stretch, weight * (1.21 / theta**2 - 1)),
                ("along", along, weight * (1.21 / theta**2 - 1)),
                ("across", across, weight * (1.21 - 1 / theta**2))]:
            print(name, "sigma_xx - sigma_yy in Pa:",
                  numpy.round(1e3 * means[1:], 2))
            self.assertLess(abs(means[1:] / mu - exact / mu).max(), 2e-3, name)
        print("random sigma_xx - sigma_yy in Pa:",
              numpy.round(1e3 * random[1:], 2))
        # After a tenth of the cycle the cells are as long as they are pulled.
        self.assertLess(abs(stretch[2]), 0.01 * stretch[1])
        self.assertLess(abs(random[2] / random[1] - 1), 0.1)
        self.assertGreater(random[-1], 0.7 * random[1])
        self.assertLess(along[-1], -5 * along[1])
        self.assertGreater(across[-1], 5 * across[1])

    def test_stress_is_as_stretch(self):
        """In an isotropic material: the same cells, but for rounding."""
        _, one = self.differences("stretch", Axis_spread="50")
        _, other = self.differences("stress", Axis_spread="50")
        for name in ("x", "y", "birth_time", "parent"):
            self.assertLess(abs(one.lineage()[name]
                                - other.lineage()[name]).max(), 1e-6, name)

    def test_least_anisotropy(self):
        """Where the ratio of the stretches, 1.1, is below it axes are random."""
        above, _ = self.differences("stretch above", Least_anisotropy="1.11")
        below, _ = self.differences("stretch below", Least_anisotropy="1.09")
        self.assertGreater(above[-1], 0.5 * above[1])
        self.assertLess(below[-1], -5 * below[1])

    def test_two_layers(self):
        """prm/examples/two-layers.prm: each layer divides along its own axis, and
        the strip bends away from the one that gets longer."""
        output = self.work / "layers"
        self.execute(SCENES.parents[1] / "prm/examples/two-layers.prm",
                     "-s", "Output/Formats=csv", output=output)
        results = Results(output)
        cells, lineage = results.last_cells(), results.lineage()
        mothers, n = axes(lineage)
        types = lineage["type"][mothers]
        self.assertTrue((types == (lineage["y"][mothers] > 0)).all())
        for kind, component in ((1, 0), (0, 1)):
            chosen = n[types == kind, component]
            # the mean cosine is I_1(20)/I_0(20) = 0.975, its scatter 0.035
            self.assertGreater(len(chosen), 100)
            self.assertLess(abs(chosen.mean() - 0.975), 0.02)
        middle = abs(cells["X"]) < 10
        ends = abs(cells["X"]) > 190
        self.assertGreater(cells["y"][middle].mean() - cells["y"][ends].mean(),
                           40)

    def test_daughters_stay_inside(self):
        """Of a ball without anything that holds it, after four divisions of all
        cells: how far they stand outside the tangent planes of its surface."""
        beyond = []
        for inside in ("false", "true"):
            run = self.run_scene(f"inside {inside}", BALL, {
                "Boundary conditions/Fixed where": "", "Time/End time": "4.5",
                "Output/Interval": "4.5",
                CYCLE + "Stay inside surface": inside})
            surface, cells = run.last_surface(), run.last_cells()
            places = positions(surface)
            nearest = KDTree(places).query(positions(cells))[1]
            normals = numpy.stack([surface[name] for name in ("nx", "ny", "nz")],
                                  axis=1)
            beyond.append(numpy.sum((positions(cells) - places[nearest])
                                    * normals[nearest], axis=1))
        print("beyond the surface, um:", [b.max() for b in beyond],
              "parts of the cells:", [(b > 1).mean() for b in beyond])
        self.assertGreater((beyond[0] > 1).mean(), 0.03)
        # cells are about 10 um long, and walls let them leave by 5e-4 of it
        self.assertLess(beyond[1].max(), 0.2)

    def test_ranks(self):
        """The lineage on two ranks is that on one."""
        for axis in ("stretch", "tangential"):
            runs = [self.run_scene(f"{axis} {ranks}", SLAB, {
                CYCLE + "Division axis": axis, CYCLE + "Axis spread": "10",
                "Time/End time": "0.7"}, ranks) for ranks in (1, 2)]
            one, two = (run.lineage() for run in runs)
            self.assertEqual(len(one), len(two))
            self.assertGreater(len(one), 3 * 512 - 1)
            for name in one.dtype.names:
                self.assertLess(abs(one[name] - two[name]).max(), 1e-5, name)

    def test_zero_in_mid_run(self):
        """A vector that becomes zero ends the run with exit code 2."""
        result = self.execute(
            self.write("scene.prm", SLAB), *overrides(
                {CYCLE + "Division axis": "fixed",
                 CYCLE + "Fixed axis": "t < 0.05; 0"}), code=2)
        for text in (CYCLE + "Fixed axis", "it is zero for the cell whose",
                     "set Division axis = random"):
            self.assertIn(text, result.stdout + result.stderr)

