# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Along which axes cells divide. Two daughters are born along their mother's axis,
the second where it points: lineage.csv tells all axes of a run."""
import numpy
from scipy.spatial import KDTree
from scipy.stats import chisquare

from tests.common.program import TESTS, WHOLE
from tests.verification.material import lame

CYCLE = "Proliferation/Cell cycle/"
AXIS = CYCLE + "Division axis"
TOGETHER = {"Time/End time": 0.5, "Time/Step": 0.5, "Proliferation/Law": "cell cycle",
            CYCLE + "Start": "together", "Output/Formats": "csv", "Output/Interval": 0}
BALL = {**TOGETHER, **WHOLE, "Tissue/Radius": 60, "Tissue/Center": "100, 0, 0", "Tissue/Cell spacing": 10,
        "Grid/Spacing": 50, "Boundary conditions/Fixed where": 1}
SLAB = {"Dimension": 2, "Method": "paper", "Time/End time": 1.1, "Time/Step": 0.1,
        "Tissue/Shape": "box", "Tissue/Size": "160, 80", "Tissue/Cell spacing": 5,
        "Grid/Spacing": 20, "Material/Energy per": "grown volume",
        "Proliferation/Law": "cell cycle", CYCLE + "Start": "together",
        CYCLE + "Size checkpoint": 1.0999, "Boundary conditions/Fixed where": 1,
        "Boundary conditions/Displacement": "0.1*X*min(t/0.1, 1); 0",
        "Solver/Newton tolerance": 1e-8, "Output/Formats": "csv", "Output/Interval": 0.1}


def axes(run):
    """The mothers among the founders, and the unit vectors along which they divided."""
    table = run.lineage.table
    pairs = table[table["generation"] == 1].groupby("parent")[["x", "y", "z"]]
    n = (pairs.last() - pairs.first()).to_numpy()
    return (table.loc[pairs.first().index.astype(int)],
            n / numpy.linalg.norm(n, axis=1)[:, None])


def axes_of(runs, keys):
    """Axes of all founders of the ball, and where these are."""
    run = runs.run("ball", BALL, {CYCLE + key: value for key, value in keys.items()})
    mothers, n = axes(run)
    assert len(n) == run.lineage.founders
    return n, mothers[["x", "y", "z"]].to_numpy()


def test_by_the_surface(runs):
    """On a sphere: radially, along its normals, tangentially. The
    boundary points are 10 um apart, the normals as coarse."""
    n, X = axes_of(runs, {"Division axis": "radial", "Radial center": "100; 0; 0"})
    outward = X - [100, 0, 0]
    distance = numpy.linalg.norm(outward, axis=1)
    outward /= distance[:, None]
    assert (n * outward).sum(axis=1).min() > 1 - 1e-4

    # near the middle all of the surface is as near
    outer = distance > 30
    assert outer.sum() > 500
    n, _ = axes_of(runs, {"Division axis": "surface normal"})
    assert (n * outward).sum(axis=1)[outer].min() > 0.97

    n, _ = axes_of(runs, {"Division axis": "tangential"})
    assert abs((n * outward).sum(axis=1)[outer]).max() < 0.25
    # any way round: the angle to the parallel is uniform
    east = numpy.cross([0, 0, 1], outward)
    north = numpy.cross(outward, east)
    turn = numpy.arctan2((n * north).sum(axis=1), (n * east).sum(axis=1))
    counts = numpy.histogram(turn[outer], 10, (-numpy.pi, numpy.pi))[0]
    # 9 degrees of freedom: above with probability 0.001
    assert chisquare(counts).statistic < 27.88


def differences(run):
    """Mean of sigma_xx - sigma_yy over the slab, at each output."""
    return numpy.array([numpy.average(cells["sigma_xx"] - cells["sigma_yy"],
                                      weights=cells["volume"])
                        for cells in map(run.cells, range(len(run.times)))])


def test_stretched_slab(runs):
    """Divisions along the stretch take the tension away, those at random do
    not. The frame keeps F = diag(1.1, 1); with F_g = I + (theta - 1) n n and
    b_e = F F_g^-2 F the difference is mu (b_xx - b_yy) theta / 1.1,
    doc/theory.md (6.3f)."""
    stretch, random, along, across = (
        differences(runs.run("slab", SLAB, {AXIS: axis, **keys})) for axis, keys in (
            ("stretch", {}), ("random", {}), ("fixed", {CYCLE + "Fixed axis": "1; 0"}),
            ("fixed", {CYCLE + "Fixed axis": "0; 1"})))
    _, mu = lame(1, 0.4)
    # theta at the outputs from t = 0.1 on: J_e is 1 + t until then, and
    # passes the checkpoint at 0.0999, a ten thousandth before
    theta = 1 + 0.1 * numpy.arange(11)
    weight = theta / 1.1
    for means, exact in ((stretch, weight * (1.21 / theta**2 - 1)),
                         (along, weight * (1.21 / theta**2 - 1)),
                         (across, weight * (1.21 - 1 / theta**2))):
        assert abs(means[1:] / mu - exact).max() < 2e-3
    # After a tenth of the cycle the cells are as long as they are pulled.
    assert abs(stretch[2]) < 0.01 * stretch[1]
    assert abs(random[2] / random[1] - 1) < 0.1
    assert random[-1] > 0.7 * random[1]
    assert along[-1] < -5 * along[1]
    assert across[-1] > 5 * across[1]


def test_stress_is_as_stretch(runs):
    """In an isotropic material: the same cells, but for rounding."""
    names = ["x", "y", "birth_time", "parent"]
    one, other = (runs.run("slab", SLAB, {AXIS: axis, CYCLE + "Axis spread": 50})
                  .lineage.table[names] for axis in ("stretch", "stress"))
    numpy.testing.assert_allclose(one, other, rtol=0, atol=1e-6)


def test_least_anisotropy(runs):
    """Where the ratio of the stretches, 1.1, is below it axes are random."""
    above, below = (differences(runs.run("slab", SLAB, {
        AXIS: "stretch", CYCLE + "Least anisotropy": least})) for least in (1.11, 1.09))
    assert above[-1] > 0.5 * above[1]
    assert below[-1] < -5 * below[1]


def test_two_layers(runs):
    """prm/examples/two-layers.prm: each layer divides along its own axis, and
    the strip bends away from the one that gets longer."""
    run = runs.run("layers", TESTS.parent / "prm/examples/two-layers.prm",
                   {"Output/Formats": "csv"})
    mothers, n = axes(run)
    assert (mothers["type"] == (mothers["y"] > 0)).all()
    for kind, component in ((1, 0), (0, 1)):
        chosen = n[mothers["type"] == kind, component]
        # the mean cosine is I_1(20)/I_0(20) = 0.975, its scatter 0.035
        assert len(chosen) > 100
        assert abs(chosen.mean() - 0.975) < 0.02
    cells = run.cells(-1)
    middle, ends = (cells["y"][where].mean()
                    for where in (abs(cells["X"]) < 10, abs(cells["X"]) > 190))
    assert middle - ends > 40


def test_daughters_stay_inside(runs):
    """Of a ball without anything that holds it, after four divisions of all
    cells: how far they stand outside the tangent planes of its surface."""
    beyond = []
    for inside in ("false", "true"):
        run = runs.run("inside", BALL, {
            "Boundary conditions/Fixed where": "", "Time/End time": 4.5, "Output/Interval": 4.5,
            CYCLE + "Stay inside surface": inside})
        surface, cells = run.surface(-1), run.cells(-1)[["x", "y", "z"]].to_numpy()
        places = surface[["x", "y", "z"]].to_numpy()
        nearest = KDTree(places).query(cells)[1]
        normals = surface[["nx", "ny", "nz"]].to_numpy()[nearest]
        beyond.append(numpy.sum((cells - places[nearest]) * normals, axis=1))
    assert (beyond[0] > 1).mean() > 0.03
    # cells are about 10 um long, and walls let them leave by 5e-4 of it
    assert beyond[1].max() < 0.2


def test_zero_in_mid_run(runs):
    """A vector that becomes zero ends the run with exit code 2."""
    said = runs.run("zero", SLAB, {AXIS: "fixed", CYCLE + "Fixed axis": "t < 0.05; 0"},
                    code=2).said
    for text in (CYCLE + "Fixed axis", "it is zero for the cell whose",
                 "set Division axis = random"):
        assert text in said
