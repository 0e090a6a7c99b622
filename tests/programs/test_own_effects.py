# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A program with an effect of its own of each kind, tests/own_effects: its
results by closed forms and against the library's own effects, on two ranks, and
resumed.
"""
import copy

import numpy
import pytest

from tests.common.bodies import block, points_scene, rectangle
from tests.common.program import TESTS, Runs, assert_same_run, without_wall_time

SCENE = TESTS / "own_effects" / "own.prm"
LOADS = "Boundary conditions/"
LIBRARY = {"Pull/Density": "0; 0", "Body force/Force density": "0; 1e-4*t*volume/100",
           LOADS + "Drag/Where": "", LOADS + "Drag/Load": "0; 0",
           LOADS + "Traction where": "Y > 49", LOADS + "Traction": "0.01*t; 0"}
DOUBLED = {"Material/Law": "neo-Hookean", "Material/Young's modulus": 2,
           LOADS + "Nitsche penalty": 1000, "Solver/Newton tolerance": 1e-10}
TWOFOLD = {"Material/Young's modulus": 1, LOADS + "Nitsche penalty": 2000,
           "Solver/Newton tolerance": 1e-10}
DIVISION = 0.5  # day
DEATH = 0.3  # day
FOUNDERS, LOST = 100, 9
STEP = 0.125  # day


@pytest.fixture(scope="module")
def own(request):
    """Runs of the program of tests/own_effects."""
    options = copy.copy(request.config.option)
    options.morula = options.morula.parent / "tests/own-effects"
    return Runs(options, request.module.__name__)


@pytest.fixture(scope="module")
def scene(own):
    """The scene itself, on two ranks."""
    return own.run("scene", SCENE, ranks=2)


def test_closed_forms_of_statistics(scene):
    rows = scene.statistics
    t = rows["time"]
    # the swelling, the law's dose, and the cycle: all whatever the stress is
    left = numpy.where(t < DEATH, FOUNDERS, FOUNDERS - LOST)
    expected = ((1 + 0.04 * t) * (1 + 0.1 * 0.5 * t))**2 * (1 + t)
    numpy.testing.assert_allclose(rows["grown_volume"] / rows["grown_volume"][0],
                                  expected * left / FOUNDERS, rtol=1e-9)  # of ten digits
    assert list(rows["cells"]) == list(numpy.where(t < DIVISION - 1e-9, 1, 2) * left)
    assert list(rows["lost"]) == [0] * 3 + [LOST] + [0] * 3
    # cells that live through steps
    numpy.testing.assert_allclose(rows["cell_days"], numpy.cumsum(rows["cells"] * rows["dt"]),
                                  rtol=1e-9)
    # Its amount stays, whatever grows, divides and moves, but for that of
    # lost cells, which stood where X > 0; cells of a grid cell share it.
    numpy.testing.assert_allclose(
        rows["amount_shared"] / 100,
        numpy.where(t < DEATH, 1.5 * FOUNDERS, 1.5 * FOUNDERS - 2 * LOST), rtol=1e-9)
    events = (scene.directory / "events.csv").read_text().splitlines()
    assert events[0] == "time,id,event,from,to,cause"
    assert (sorted(line.split(",", 2)[2] for line in events[1:])
            == ["anoikis,,,no hold"] * LOST + ["removal,,,"] * LOST)
    assert {line.split(",")[0] for line in events[1:]} == {"0.3"}


def test_closed_forms_of_cells(scene):
    for number, time in enumerate(scene.statistics["time"]):
        cells = scene.cells(number)
        # Daughters grow old twice as fast: the pace is 1 + generation.
        age = time if time < DIVISION - 1e-9 else 2 * (time - DIVISION)
        numpy.testing.assert_allclose(cells["age"], age, atol=1e-12)
        # An effect sees what others had at the beginning of the step.
        numpy.testing.assert_allclose(cells["earlier_dose"], 0.5 * max(0, time - STEP),
                                      atol=1e-12)
        # A founder has volume, place, field and depth when the trait begins: 100, 1 and 5, ...
        numpy.testing.assert_allclose((cells["at_first"] - 1) % 100 % 10, 5, atol=1e-9)
        assert {*cells["at_first"] // 100} == {2, 3}
        # Growth dilutes both fields alike, and no cell makes any.
        numpy.testing.assert_allclose(cells["made"] / (cells["raw"] + cells["made"]),
                                      -numpy.expm1(-2 * time), rtol=1e-9)
    first = scene.cells(0)
    assert len(set(first["shared"])) < FOUNDERS / 4
    assert first["shared"].max() > 1.5 * first["shared"].min()
    # every cell has divided along y
    pairs = scene.cells(4).groupby("parent")[["x", "y"]]
    assert list(pairs.size()) == [2] * (FOUNDERS - LOST)
    apart = abs(pairs.first() - pairs.last())
    assert apart["x"].max() < 1e-9
    assert apart["y"].min() > 1


def test_a_column_of_a_trait_is_a_variable(own):
    cells = own.run("variable", SCENE, {"Ageing/Pace": "1 + earlier_dose",
                                        "Time/End time": 0.375}).cells(3)
    # Of the three steps the last one begins with a dose that is not zero.
    numpy.testing.assert_allclose(cells["age"], STEP * (3 + 0.5 * STEP), rtol=1e-9)
    text = own.explain(SCENE, {"Cell numbers/Names": "earlier_dose"}, code=1)
    assert "another number of cells has this name" in text


def test_force_and_condition_are_the_librarys(own):
    one, library = (own.run(name, SCENE, keys)
                    for name, keys in (("own", {}), ("library", LIBRARY)))
    assert without_wall_time(one.directory) == without_wall_time(library.directory)
    assert one.statistics["xmax"].iloc[-1] > 50.5
    assert {"pull", "drag"} <= {*one.timings.index}
    assert not {"body force", "traction"} & {*one.timings.index}


def test_material_is_twice_as_stiff(own):
    one, library = (own.run(name, SCENE, keys).statistics
                    for name, keys in (("twofold", TWOFOLD), ("doubled", DOUBLED)))
    names = ["mean_energy_density", "total_volume", "xmax", "ymax"]
    numpy.testing.assert_allclose(one[names], library[names], rtol=1e-8)
    assert one["mean_energy_density"].iloc[-1] > 0


def test_melting_takes_the_shear(own):
    # Tissue that does not grow, sheared evenly by its whole surface and then
    # held: nothing but the shear is in it.
    still = {"Growth/Dose/Uptake": 0, "Swelling/Stretch": 1,
             "Proliferation/Cell cycle/Start": "waiting", "Anoikis/Where": "",
             "Anoikis/After": 0, LOADS + "Drag/Load": "0; 0", "Pull/Density": "0; 0",
             LOADS + "Fixed where": 1, LOADS + "Displacement": "0.4*Y*min(t, 0.5); 0"}
    melted, held = (own.run("melting", SCENE, {**still, "Melting/When": when})
                    .cells(6)["sigma_xy"].abs().mean() for when in ("t > 0.7", "t > 9"))
    assert melted < 0.01 * held


def test_resumed(own, scene):
    assert_same_run(scene, own.resumed("parts", SCENE, {}, 0.25, ranks=2))


def test_explained(own):
    text = own.explain(SCENE)
    for line in ("dose, Uptake = 0.5 1/day, Response = 0.1", "axis = along, Direction = 0, 1, 0",
                 "Record = true, Pace = 1 + generation", "Density = 0; 1e-4*t*volume/100",
                 "Stretch = 1 + 0.04*t", "When = t > 0.7",
                 "Where = X > 40 && Y > -40, After = 0.3", "Rate = 2", "Take = true",
                 "at 10 boundary points, Where = Y > 49"):
        assert line in text


@pytest.mark.parametrize("key, value", [
    (LOADS + "Drag/Where", "Y > 999"), ("Growth/Dose/Uptake", "t"),
    # Forces and fates are asked at all founders, before the run.
    ("Pull/Density", "log(J_e - 1); 0"), ("Ageing/Pace", "log(J_e - 1)")])
def test_refused(own, key, value):
    assert f"{key} = '{value}'" in own.explain(SCENE, {key: value}, code=1)


def test_springs_between_blocks(own):
    """Springs hold a block at another one: against its load, and summed up
    over the points; on any ranks, and resumed."""
    k, reach, load = 1e-3, 8.0, 0.05
    keys = points_scene(own, block(0, 30, "a") + block(33, 63, "b"),
                        [[rectangle(0, 30)], [rectangle(33, 63)]])
    keys = {**{key: value for key, value in keys.items() if not key.startswith("Contact/")},
            "Tethers/Stiffness": k, "Tethers/Reach": reach,
            LOADS + "Fixed where": "Y < 0.001", LOADS + "Traction where": "Y > 62.999",
            LOADS + "Traction": f"0; 0.02 + {load}*t", "Tissue/Boundary points": 144,
            "Output/Snapshot interval": 0.2, "Solver/Newton tolerance": 1e-10}
    found = []
    for ranks in (3, 1):
        run = own.run(f"springs-{ranks}", keys, ranks=ranks)
        rows = run.forces[run.forces["kind"] == "tethers"]
        assert set(rows["name"]) == {"body 0 on body 1"}
        numpy.testing.assert_allclose(rows["force_y"], -60 * (0.02 + load * rows["time"]),
                                      rtol=1e-6)
        found.append(rows["force_y"].iloc[-1])
        before, after = (run.surface(i) for i in (3, 4))
        x, n = before[["x", "y"]].to_numpy(), before[["nx", "ny"]].to_numpy()
        area, y, body = (table.to_numpy() for table in (before["area"], after["y"],
                                                        before["body"]))
        force = 0.0
        for b in numpy.flatnonzero(body == 1):
            near = numpy.linalg.norm(x[b] - x, axis=1) <= reach
            c = numpy.flatnonzero((body == 0) & near & (n @ n[b] < 0))
            force -= (k * area[b] * area[c] * (y[b] - y[c])).sum()
        assert abs(force / found[-1] - 1) <= 1e-5
    numpy.testing.assert_allclose(*found, rtol=1e-8)
    assert_same_run(run, own.resumed("springs-parts", keys, {}, 0.2))
    assert "tethers" in run.timings.index
    text = own.explain(keys, {"Contact/Between": "bodies"}, code=1)
    assert "Tethers/Stiffness = '0.001'" in text
    assert "bodies have contact already" in text
