# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Numbers of cells: their order in the step by closed forms, the rules at
division, what reads them, several ranks, a resumed run; Delta and Notch."""
import numpy
import pytest

from tests.common.program import TESTS, assert_same_run

ROOM = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "60, 60",
        "Tissue/Cell spacing": 10, "Tissue/Redistribution": "false", "Grid/Spacing": 30,
        "Time/End time": 1, "Time/Step": 0.1, "Output/Formats": "csv", "Output/Interval": 1}
LATTICE = TESTS.parent / "prm/examples/delta-and-notch.prm"


def numbers(**all_keys):
    """Keys of numbers, given as NAME={key: value}."""
    keys = {"Cell numbers/Names": ", ".join(all_keys)}
    for name, own in all_keys.items():
        for key, value in own.items():
            keys[f"Cell numbers/{name}/{key}"] = value
    return keys


def test_second_order(runs):
    """An oscillation, what reads it in time, and what reads it by the neighbours,
    whose values of the step's end are known in the next step only."""
    keys = {**ROOM, **numbers(u={"Initial": 1, "Rate": "-2*v"}, v={"Rate": "2*u"},
                              w={"Rate": "around_u - w"}, s={"Rate": "3*t^2 - s"})}
    errors = []
    for step in (0.05, 0.025, 0.0125):
        cells = runs.run(f"order-{step}", {**keys, "Time/Step": step}).cells(1)
        t = 1.0
        apart = {"u": numpy.cos(2 * t), "v": numpy.sin(2 * t),
                 "w": (numpy.cos(2 * t) + 2 * numpy.sin(2 * t) - numpy.exp(-t)) / 5,
                 "s": 3 * (t**2 - 2 * t + 2) - 6 * numpy.exp(-t)}
        apart = {name: abs(cells[name] - value).max() for name, value in apart.items()}
        errors.append([numpy.hypot(apart["u"], apart["v"]), apart["w"], apart["s"]])
    errors = numpy.array(errors)
    assert errors[-1].max() < 1e-3
    assert (numpy.log2(errors[:-1] / errors[1:]) > 1.8).all(), errors


CYCLE = {"Proliferation/Law": "cell cycle", "Proliferation/Cell cycle/Start": "together",
         "Proliferation/Cell cycle/Duration": 1, "Proliferation/Cell cycle/G0 exit rate": 0,
         "Time/Step": 0.2}


def test_rules_at_division(runs):
    """All cells divide at 0.5, in the middle of a step."""
    run = runs.run("rules", {**ROOM, **CYCLE, "Tissue/Size": "120, 120", **numbers(
        same={"Initial": "1 + X/100", "Rate": 2},
        half={"Initial": "1 + X/100", "Rate": 2, "At division": "halved"},
        decays={"Initial": 8, "Rate": "-decays", "At division": "halved"},
        drawn={"Initial": "5*noise + 1", "At division": "new"},
        clone={"Initial": "noise"},
        part={"Initial": "1 + X/100", "At division": "split with noise"},
        within={"Initial": 3, "Rate": 10, "Clamp": "0, 4"})})
    before, cells = run.cells(0), run.cells(1)
    births = run.lineage.table
    mothers = before.set_index("id").loc[cells["parent"]].reset_index()
    assert len(cells) == 2 * len(before)
    start = 1 + cells["X"] / 100
    numpy.testing.assert_allclose(cells["same"], start + 2, rtol=1e-6)
    numpy.testing.assert_allclose(cells["half"], (start + 1) / 2 + 1, rtol=1e-6)
    numpy.testing.assert_allclose(cells["decays"], 4 * numpy.exp(-1), rtol=0.01)
    assert (cells["clone"] == mothers["clone"]).all()
    assert len(set(cells["drawn"])) == len(cells) and cells["drawn"].between(1, 6).all()
    assert set(cells["within"]) == {4}
    share = (cells["part"] / mothers["part"]).to_numpy()
    sums = cells.groupby("parent")["part"].sum()
    numpy.testing.assert_allclose(sums, before.set_index("id")["part"].loc[sums.index], rtol=1e-6)
    assert abs(share.std() - 0.1) < 0.02
    # The table of births has them, too, as does statistics.csv their means.
    numpy.testing.assert_allclose(births["part"][len(before):], cells.sort_values("id")["part"],
                                  rtol=1e-6)
    rows = run.statistics
    numpy.testing.assert_allclose(rows["part_mean"].iloc[[0, -1]],
                                  [before["part"].mean(), cells["part"].mean()], rtol=1e-6)
    numpy.testing.assert_allclose(rows["same_mean"], 1 + 2 * rows["time"], rtol=1e-6)


def test_on_ranks_and_resumed(runs):
    keys = {**ROOM, **CYCLE, "Time/End time": 0.8, "Output/Interval": 0.4, **numbers(
        a={"Initial": "normal(1, 0.2)", "Rate": "around_b - a*pressure",
           "At division": "split with noise"},
        b={"Initial": "a", "Rate": "0.3*x/30 - b", "At division": "halved"}),
        "Proliferation/Cell cycle/Duration": "0.6 + 0.2*b", "Growth/Law": "rate",
        "Growth/Rate/Rate": "0.1*a", "Material/Young's modulus": "1 + 0.1*a^2"}
    one = runs.run("one", keys)
    assert one.cells(2)["a"].std() > 0.05
    for ranks in (2, 3):
        many = runs.run(f"{ranks}-ranks", keys, ranks=ranks)
        numpy.testing.assert_allclose(many.cells(2), one.cells(2), rtol=1e-6, atol=1e-6)
    assert_same_run(one, runs.resumed("parts", keys, {}, 0.4))


def test_what_reads_them(runs):
    """Growth, death, types and stiffness by a number; a type has a rate of its
    own, and a founder's clock the number of t = 0."""
    run = runs.run("read", {**ROOM, **CYCLE, "Time/Step": 0.1, "Output/Interval": 0.5, **numbers(
        dose={"Initial": "1 + (X > 0)", "Rate": 1}),
        "Proliferation/Cell cycle/Duration": "dose", "Cell types/Names": "plain, fast",
        "Cell types/fast/Where": "Y > 0", "Cell types/fast/Cell numbers/dose/Rate": 2,
        "Death/When": "dose > 3.55", "Time/End time": 1.3})
    cells = run.cells(2)
    numpy.testing.assert_allclose(
        cells["dose"], 1 + (cells["X"] > 0) + 1 + (cells["Y"] > 0), rtol=1e-6)
    # Founders divide in the middle of their cycle, of 1 day or 2.
    born = run.lineage.table
    first = born[born["parent"] >= 0].groupby("parent")["birth_time"].first()
    assert set(first.round(9)) == {0.5, 1.0}
    deaths = run.events[run.events["event"] == "death"]
    assert len(deaths) > 0 and deaths["time"].min() >= 0.77


@pytest.mark.parametrize("names, word", [
    ("phase", "phase"), ("volume", "variable or function"), ("c", "A field, a type"),
    ("b", "A field, a type"), ("Dose", "small letters"), ("deformation", "a column"),
    ("id", "column 'id'"), ("a, a", "twice"), ("1x", "begin with a letter")])
def test_names_that_collide(runs, names, word):
    text = runs.refused({**ROOM, **CYCLE, "Cell numbers/Names": names, "Fields/Names": "c",
                         "Fields/c/Diffusion": 1, "Fields/c/Consumption": 1,
                         "Cell types/Names": "kind, b"})
    assert "Cell numbers/Names" in text and word in text


@pytest.mark.parametrize("key, value, word", [
    ("Initial", "b", "not named before"), ("Initial", "neighbours", "around it"),
    ("Rate", "1/0", "finite"), ("Rate", "around_q", "ends with no name"),
    ("Clamp", "2, 1", "smaller one first")])
def test_refused(runs, key, value, word):
    assert word in runs.refused({**ROOM, **numbers(a={key: value}, b={})})


def test_absent(runs):
    assert "ell numbers" not in runs.explain(ROOM)


def uniform(a=0.01, b=100):
    """Delta and Notch where all cells are alike, and F'G' there."""
    low, high = 0.0, 1.0
    for _ in range(100):
        delta = (low + high) / 2
        notch = delta**2 / (a + delta**2)
        low, high = (low, delta) if 1 / (1 + b * notch**2) < delta else (delta, high)
    slope_F = 2 * a * delta / (a + delta**2)**2
    slope_G = -2 * b * notch / (1 + b * notch**2)**2
    return delta, notch, slope_F * slope_G


def test_delta_and_notch(runs):
    """A checkerboard of Notch alone grows on squares as exp(-t) cosh(s t), with
    s^2 = -F'G': where that is above 1, and not below."""
    checker = "(2*(cos(pi*(X - 5)/10)*cos(pi*(Y - 5)/10) > 0) - 1)"
    for b, grows in ((100, True), (1, False)):
        delta, notch, product = uniform(b=b)
        assert (-product > 1) == grows
        keys = {"Cell numbers/delta/Initial": f"{delta}", "Time/End time": 2,
                "Cell numbers/notch/Initial": f"{notch} + 1e-3*{checker}",
                "Cell numbers/delta/Rate": f"1/(1 + {b}*notch^2) - delta",
                "Tissue/Size": "100, 100", "Output/Interval": 1, "Time/Step": 0.05,
                "Output/Snapshot interval": 2}
        run = runs.run(f"checker-{b}", LATTICE, keys)
        apart = [run.cells(n)["notch"].std() for n in (1, 2)]
        rate = numpy.log(apart[1] / apart[0])
        s = (-product)**0.5
        assert abs(rate - (numpy.log(numpy.cosh(2 * s) / numpy.cosh(s)) - 1)) < 0.01
    run = runs.run("pattern", LATTICE, {"Tissue/Size": "100, 100", "Output/Interval": 20})
    cells = run.cells(1)
    senders = cells["delta"] > 0.5
    assert 0.35 < senders.mean() < 0.55
    assert (cells["around_delta"][senders] < 0.3).all()


def test_delta_and_notch_on_hexagons(runs):
    """The same with the wave of three sublattices, and half of -F'G'."""
    delta, notch, product = uniform()
    places = [(10 * (i + 0.5 * (j % 2)), 5 * 3**0.5 * j) for j in range(15) for i in range(14)]
    file = runs.write("hexagons.csv", "x,y,volume\n" + "".join(
        f"{x:.12g},{y:.12g},{50 * 3**0.5:.12g}\n" for x, y in places))
    run = runs.run("hexagons", LATTICE, {
        "Tissue/Shape": "points", "Tissue/Points file": file, "Time/End time": 2,
        "Time/Step": 0.05, "Output/Interval": 1, "Cell numbers/delta/Initial": f"{delta}",
        "Cell numbers/notch/Initial": f"{notch} + 1e-3*cos(pi*X/7.5)"})
    apart = []
    for number in (1, 2):
        cells = run.cells(number)
        inside = cells["x"].between(35, 105) & cells["y"].between(30, 95)
        wave = numpy.cos(numpy.pi * cells["x"] / 7.5)[inside]
        apart.append((wave * (cells["notch"][inside] - notch)).sum() / (wave**2).sum())
    s = (-product / 2)**0.5
    assert s > 1  # unstable
    assert abs(numpy.log(apart[1] / apart[0] / numpy.cosh(2 * s) * numpy.cosh(s)) + 1) < 0.01
