# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/accuracy: its estimates against made-up values whose limit, order, noise
and front are known, and what it refuses. Only the refusals ask the program."""
import math
from types import SimpleNamespace

import numpy
import pandas
import pytest
from morula.accuracy import offsets, request
from morula.accuracy.bar import Bar, bias, duration, scatter
from morula.accuracy.estimate import estimate
from morula.accuracy.further import Further
from morula.accuracy.limits import limit_of, observed_order, size_of
from morula.accuracy.options import parser
from morula.ladder import Plan, read_ladder, read_seeds
from morula.measures import read_measure
from morula.refusal import Refused
from morula.scene import normal
from tests.common import requests
from tests.common.program import TESTS

pytestmark = pytest.mark.quick
SPACE = {"Dimension": "3"}  # keys of a scene
COARSE = "Grid/Spacing=100,75,50"
DISC = TESTS / "programs/disc.prm"


class MadeUpScene:
    """Keys without a program behind them."""

    dimension = 3
    keys = {"Grid/Spacing": "50", "Tissue/Cell spacing": "10",
            "Time/Step": "1", "Grid/Occupation parameter": "0.85",
            "Solver/Newton tolerance": "1e-6", "Tissue/Size": "1, 2, 3"}

    def __getitem__(self, key):
        return self.keys[key]

    def require_key(self, key, option):
        assert key in self.keys, (key, option)


class MadeUpReference:
    def value(self, _measure, _time):
        return 5.0, 0.1


def plan_of(*ladders):
    scene = MadeUpScene()
    return Plan(scene, [read_ladder(text, scene) for text in ladders])


def estimate_of(plan, function, seeds=(0.0,), reference=None):
    """With the values function(number of each key, seed)."""
    values = {point: numpy.array([function(*map(float, point), seed)
                                  for seed in seeds]) for point in plan.points}
    return estimate(plan, read_measure("zmax", SPACE), 1.0, values, reference)


def limits_of(sizes, values, kind="zero"):
    return limit_of(sizes, [numpy.atleast_1d(value) for value in values], kind)


def near(value, tolerance=1e-6):
    return pytest.approx(value, rel=0, abs=tolerance)


@pytest.mark.parametrize("order", [0.6, 1.0, 2.0, 3.5])
def test_order_and_limit_are_found(order):
    sizes = (100.0, 33.0, 50.0, 75.0)
    values = [numpy.array([7.0 + 1e-4 * size**order]) for size in sizes]
    limit = limit_of(sizes, values, "zero")
    assert limit.order == near(order, 1e-5)
    assert limit.value == near(7.0)
    assert limit.uncertainty == near(1e-4 * 33.0**order)


@pytest.mark.parametrize("values", [(1.0, 3.0, 2.0), (1.0, 2.0, 2.2),
                                    (1.0, 1.0001, 9.0)])
def test_no_order_is_made_up(values):
    """Values that turn round, that hardly converge, that jump: the finest
    one, with the spread as its uncertainty."""
    limit = limits_of((1.0, 2.0, 4.0), values)
    assert (limit.note, limit.value) == ("not asymptotic", values[0])
    assert limit.uncertainty == near(max(values) - min(values))


def test_values_that_show_no_order():
    limit = limits_of((50.0, 100.0), (2.0, 3.0))
    assert (limit.note, limit.uncertainty) == ("two values", 1.0)
    sizes = (1e-2, 1e-4, 1e-6)
    limit = limits_of(sizes, [1.0 + size for size in sizes], "tolerance")
    assert limit.value == 1.0 + 1e-6
    assert limit.uncertainty == near(1e-4 - 1e-6, 1e-12)
    seeds = 1.0 + 0.1 * numpy.random.default_rng(1).standard_normal((3, 8))
    assert limits_of((1.0, 2.0, 4.0), seeds).note == "noise"
    assert math.isnan(observed_order((1, 2, 4), (1, 3, 2)))


@pytest.mark.parametrize("value, kind, dimension, size", [
    ("50", "zero", 3, 50), ("400", "large", 3, 0.05), ("400", "large", 2, 0.0025),
    ("0", "tolerance", 3, None), ("iterative", "zero", 3, None),
    ("1", None, 3, None)])
def test_sizes(value, kind, dimension, size):
    assert size_of(value, kind, dimension) == size


def test_errors_that_add_up():
    """Q = 5 + h^2 + 3 dt: the ladders find 5 though no run is near it, and what
    either has in it."""
    def law(h, dt, _):
        return 5 + 1e-4 * h**2 + 3 * dt

    plan = plan_of(COARSE, "Time/Step=4,2,1")
    assert len(plan.points) == 5
    found = estimate_of(plan, law)
    assert found.right == near(5.0)
    assert found.errors[plan.own] == near(0.25 + 3)
    assert [part.change for part in found.parts] == [near(-0.25), near(-3.0)]
    assert found.uncertainty == near(3.25)


def bar_of(parts, orders=(), powers=None, **sizes):
    return Bar(read_measure("zmax", SPACE), 235.7123, parts, dict(orders), 41.0,
               {"grid": 40.0, "cells": 10.0, "step": 0.1, **sizes},
               powers or {"grid": 1.0, "cells": 3.0, "step": 1.0})


@pytest.mark.parametrize("order", [0.8, 1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("ratios", [(1.25, 1.5), (2.0, 4.0), (1.5,), (2.0,), (0.5,)])
def test_bias_of_a_power_law(order, ratios):
    """5 + r^order, whose error is 1 at r = 1: the estimate is not below it, and not
    far above, also where one coarser value must do, or one finer."""
    found, seen = bias({ratio: 5 + ratio**order for ratio in (1.0, *ratios)})
    assert 1 <= found < (6 if order < 3 else 12) or order < 1 and found > 0.8
    assert seen == near(min(max(order, 1), 2) if len(ratios) == 2 else 1.0, 1e-4)


def test_bias_without_an_order():
    """Values that turn round, that hardly change, that differ by noise."""
    assert bias({1.0: 5, 1.25: 7, 1.5: 6}) == (2.5, 1.0)
    assert bias({1.0: 5, 1.25: 5, 1.5: 5}) == (0.0, 1.0)
    assert bias({1.0: 5, 1.25: 5.5, 1.5: 6}, noise=3) == (1.0, 1.0)


def test_scatter_of_few_runs():
    """Of normal numbers a single one is off by more in one case of ten."""
    numbers = numpy.random.default_rng(1).standard_normal((4000, 5))
    off = [abs(sample[0]) > scatter(sample[1:])[1] for sample in numbers]
    assert 0.08 < numpy.mean(off) < 0.16
    assert scatter([1.0, 3.0])[0] == near(math.sqrt(2))


def test_parts_add_up():
    """What has a direction by magnitude, what is independent in squares; what is not
    known is said."""
    bar = bar_of({"grid": 2.0, "step": 1.0, "position": 2.0, "chance": 2.0, "cells": None})
    assert bar.error == near(math.sqrt(9 + 4 + 4))
    assert bar.text().startswith("zmax = 235.7 ± 4.1 µm (grid 2.0, ")
    assert "cells not known); 41 s; half of it would cost " in bar.text()
    assert bar_of({"grid": 0.0}).text().endswith("0 ± 0.00000000 µm (grid 0); 41 s")
    assert bar_of({"chance": 60.0}).text().startswith("zmax = 236 ± 60 µm (chance 60)")
    assert [duration(x) for x in (0.126, 41, 89.9, 310, 8000, 3e5)] == [
        "0.13 s", "41 s", "90 s", "5.2 min", "2.2 h", "3.5 days"]


def test_half_of_the_error():
    """The mean of four runs; half of the grid spacing, of which the cells take part as
    soon as there are three to an edge; the cheaper of two parts first."""
    assert bar_of({"chance": 2.0}).half()[1:] == (4, near(4 * 41))
    sizes, runs, seconds = bar_of({"grid": 2.0}, {"grid": 1.0}).half()
    assert (sizes["grid"], sizes["cells"], runs) == (near(20), near(20 / 3), 1)
    assert seconds == near(41 * 2 * 1.5**3)
    sizes, _, seconds = bar_of({"grid": 2.0, "step": 2.0}, {"grid": 1.0, "step": 2.0}).half()
    assert sizes["grid"] > 20 and sizes["step"] < 0.1 and seconds < 41 * 4


def test_runs_that_are_missing():
    """Further runs that failed leave the part unknown, or what is left tells it."""
    made = Further.__new__(Further)
    made.scene, made.records, made.random = MadeUpScene(), {}, False
    made.biased = ("grid", "cells")
    made.scene.number = lambda key: float(made.scene[key])
    run = SimpleNamespace(statistics=pandas.DataFrame({"wall_seconds": [0.0, 8.0]}))
    found = {("grid", 1.0): 5.0, ("cells", 1.0): 5.0, ("cells", 1.5): 5.5,
             ("position", 0): 5.0, ("position", 2): 5.2}
    bar = made._bar(read_measure("zmax", SPACE), found, run)
    assert bar.parts["grid"] is None and bar.parts["cells"] > 0 and bar.parts["position"] > 0
    assert "grid not known" in bar.text()
    bar = made._bar(read_measure("cells", SPACE), found, run)
    assert "cells" not in bar.parts  # their number is what L says


def test_a_key_counts_once():
    """The same grid spacing alone and with the cells': one of the two."""
    plan = plan_of(COARSE, "Grid/Spacing,Tissue/Cell spacing=100:20,75:15,50:10")
    found = estimate_of(plan, lambda h, _, __: 5 + 1e-4 * h**2)
    assert [part.used for part in found.parts] == [True, False]
    assert found.right == near(5.0)


def test_setting_without_a_limit():
    plan = plan_of("Grid/Occupation parameter=0.5,0.85,1")
    found = estimate_of(plan, lambda C, _: 5 + C)
    assert found.uncertainty == near(0.5)
    assert found.errors[plan.own] == 0


def test_noise():
    """What seeds add to all runs alike is scatter of the values, not noise
    of the differences."""
    plan, seeds = plan_of(COARSE), (-1.0, 0.0, 1.0)
    found = estimate_of(plan, lambda h, s: 5 + 1e-4 * h**2 + s, seeds)
    assert found.scatter[plan.own] == near(1.0)
    assert found.noise[plan.own] == near(0.0, 1e-9)
    assert found.right == near(5.0)
    found = estimate_of(plan, lambda h, s: 5 + 1e-4 * h**2 + s, seeds,
                        MadeUpReference())
    assert found.noise[plan.own] == near(2 / math.sqrt(3))


def test_front():
    """Errors 9, 5, 6, ... at the costs 1, 2, 3, ..."""
    laws = {100: 9, 90: 5, 80: 6, 70: 1, 60: 1, 50: 4}
    found = estimate_of(plan_of("Grid/Occupation parameter="
                                + ",".join(map(str, laws)) + ",0.85"),
                        lambda C, _: 5 + laws.get(C, 100), reference=MadeUpReference())
    costs = dict(zip(found.errors, (99, 1, 2, 3, 4, 5, 2)))
    assert found.front(costs) == [("100",), ("50",), ("70",)]


def test_offsets_fill_the_grid_cell():
    """Of 2^k offsets each direction has the multiples of 1/2^k once, the
    first being the scene's own; more of them add to fewer."""
    for dimension in (2, 3):
        found = offsets.fractions(16, dimension)
        assert found[0] == (0.0,) * dimension
        for axis in range(dimension):
            assert sorted(point[axis] for point in found) == [
                i / 16 for i in range(16)]
        for number in (2, 3, 7):
            assert offsets.fractions(number, dimension) == found[:number]


def test_samples():
    """Every seed at every offset, which are parts of the spacing."""
    keys = {"Grid/Offset": "1, 2.5", "Grid/Spacing": "40"}
    assert offsets.moved_offset(keys, (0.5, 0.25, 0.75)) == "21,12.5,30"
    found = offsets.samples([1, 2], 2, 2)
    assert [(s.seed, s.moved) for s in found] == [
        (1, (0.0, 0.0)), (2, (0.0, 0.0)), (1, (0.5, 0.5)), (2, (0.5, 0.5))]
    assert found[0].overrides(keys) == [("Random seed", "1")]
    assert found[3].overrides(keys) == [("Grid/Offset", "21,22.5"),
                                        ("Random seed", "2")]
    assert offsets.samples(None, None, 3) == [offsets.Sample(None, None)]


def test_measures_that_a_scene_has():
    """Numbers of cells by type and values of fields, by their names."""
    keys = {**SPACE, "Cell types/Names": "stem, leaf", "Fields/Names": "oxygen"}
    for word in ("cells_stem", "cells_leaf", "oxygen_mean"):
        assert read_measure(word, keys).column == word
        with pytest.raises(Refused, match=word):
            read_measure(word, SPACE)
    with pytest.raises(Refused, match="Did you mean 'cells_leaf'"):
        read_measure("cells_leave", keys)


def test_ladders():
    """Values with commas; the same keys under two names; only what changes is in a
    label; a scene beside the path is on the line, but not on the path."""
    assert len(plan_of("Tissue/Size=1,2,3.0|2,2,2").points) == 2
    assert normal(" 1e1, 2.50") == "10,2.5"
    plan = plan_of("coarse: Grid/Spacing,Time/Step=100:2,75:2",
                   "fine: Grid/Spacing,Time/Step=75:0.5,25:0.5")
    coarse, fine = plan.ladders
    assert (coarse.name, fine.name) == ("coarse", "fine")
    assert [plan.rung_label(coarse, point)
            for point in plan.path(coarse, plan.own)] == ["100", "75"]
    assert plan.own in plan.line(coarse, plan.own)
    assert read_seeds("1..3, 7") == [1, 2, 3, 7]


SPACING = ["--vary", "Grid/Spacing=80,40"]
GOOD = [*SPACING, "--measure", "xmax,total_volume"]
MEASURE = GOOD[2:]

# What the refusal must say, and the words after the scene.
NONSENSE = [
    ("Did you mean 'Grid/Spacing'", ["--vary", "Grid/Spcing=80,40", *MEASURE]),
    *(("a ladder or --offsets", [*MEASURE, option, "1"]) for option in (
        "--seeds", "--reference")),
    ("at least two values", ["--vary", "Grid/Spacing", *MEASURE]),
    ("Not so: ''", ["--vary", "Grid/Spacing=80,,40", *MEASURE]),
    ("at least two values", ["--vary", "Grid/Spacing=80", *MEASURE]),
    ("one ladder for", [*SPACING, "--vary", "Grid/Spacing=20,10", *MEASURE]),
    ("Not so: '40'", ["--vary", "Grid/Spacing,Tissue/Cell spacing=80:20,40",
                      *MEASURE]),
    ("each key once", ["--vary", "Grid/Spacing,Grid/Spacing=8:8,4:4", *MEASURE]),
    ("Use --seeds", ["--vary", "Random seed=1,2", *MEASURE]),
    ("-s sets it", ["--vary", "Time/End time=1,2", *MEASURE]),
    ("how well", ["--vary", "Output/Formats=csv|vtu", *MEASURE]),
    ("from 2 to 256", [*MEASURE, "--offsets", "1"]),
    ("moves the grid", ["--vary", "Grid/Offset=0,0|5,5", *MEASURE, "--offsets", "4"]),
    ("1200 runs", [*GOOD, "--seeds", "1..3", "--offsets", "200"]),
    ("vary Method alone", ["--vary", "Method=paper,consistent", "--vary",
                           "Boundary conditions/Nitsche penalty=20,1000", *MEASURE]),
    ("mean 'total_volume'", [*SPACING, "--measure", "total_volum"]),
    ("wall_seconds", [*SPACING, "--measure", "wall_seconds"]),
    ("once", [*SPACING, "--measure", "xmax,xmax"]),
    *(("reductions are", [*SPACING, "--measure", word]) for word in (
        "", "cell:volume", "cells:average(volume)", "cells:p101(volume)",
        "cells:max(volume", "statistics:max(xmax)", "max(xmax)")),
    ("'zmax'", [*SPACING, "--measure", "zmax"]),
    ("from low to high", [*GOOD, "--seeds", "8..1"]),
    ("each seed once", [*GOOD, "--seeds", "1..3,2"]),
    ("'1..8'", [*GOOD, "--seeds", "one"]),
    ("nothing is random", [*GOOD, "--seeds", "1..3", "-s", "Proliferation/Law=none"]),
    ("1998 runs", [*GOOD, "--seeds", "1..999"]),
    ("use -s", [*GOOD, "-s", "Time/Stop at cells=300"]),
    ("integer >= 1", [*GOOD, "--jobs", "0"]),
    ("can be read", [*GOOD, "--reference", "nowhere.csv"]),
    ("between the key", [*GOOD, "-s", "Grid/Spacing"]),
    ("sphere", [*GOOD, "-s", "Tissue/Shape=cube"]),
    ("executable", [*GOOD, "--morula", "nowhere/morula"]),
    ("what --help shows", [*GOOD, "--meausre", "xmax"]),
]

# What the refusal must say, the reference file, and further words.
BAD_REFERENCES = [
    ("'xmax'", "apex\n310\n", []),
    ("'large'", "xmax,total_volume\n310,large\n", []),
    ("finite", "xmax,total_volume\nnan,3\n", []),
    ("''", "xmax,total_volume\n310\n", []),
    ("as many values", "xmax,total_volume\n310,1,2\n", []),
    ("as many values", "xmax,total_volume\n", []),
    ("It has 2", "xmax,total_volume\n1,2\n3,4\n", []),
    ("row for day 1", "time,xmax,total_volume\n0.5,1,2\n", []),
    ("errors >= 0", "xmax,xmax_error,total_volume\n1,-1,2\n", []),
]


@pytest.fixture(scope="module")
def asked(runs):
    with requests.asked(request, parser, runs.options.morula) as ask:
        yield ask


@pytest.mark.parametrize("said, words", NONSENSE)
def test_refusals(asked, said, words):
    with pytest.raises(Refused) as refused:
        asked(DISC, *words)
    assert said in str(refused.value)


@pytest.mark.parametrize("said, text, words", BAD_REFERENCES)
def test_bad_references(asked, runs, said, text, words):
    with pytest.raises(Refused) as refused:
        asked(DISC, *GOOD, "--reference", runs.write("reference.csv", text), *words)
    assert said in str(refused.value)


def test_references(asked, runs):
    """A column that has no error is exact."""
    file = runs.write("reference.csv", "# days\ntime,xmax,xmax_error,ymax\n"
                      "0.5,310,0.5,620\n1,320,0.25,640\n")
    reference = asked(DISC, *SPACING, "--measure", "xmax,ymax", "--reference", file).reference
    xmax, ymax = (read_measure(word, SPACE) for word in ("xmax", "ymax"))
    assert reference.value(xmax, 1.0) == (320.0, 0.25)
    assert reference.value(ymax, 0.5) == (620.0, 0.0)


def test_scenes_that_are_refused(asked, runs):
    with pytest.raises(Refused, match="can be read"):
        asked("nowhere.prm", *GOOD)
    points = runs.write("points.csv", "x,y,z\n0,0,0\n20,0,0\n0,20,0\n")
    scene = runs.write("points.prm", "subsection Tissue\n  set Shape = points\n"
                       f"  set Points file = {points}\nend\n")
    with pytest.raises(Refused, match="no surface"):
        asked(scene, *GOOD)
