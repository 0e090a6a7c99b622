# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Several lumens: each has a content of its own, and what merges is added."""
import numpy as np
import pytest

from tests.common.program import TESTS, assert_same_run
from tests.scenes.test_pressures import Shell

EXAMPLE = TESTS.parent / "prm/examples/two-lumens.prm"
A, B, MIDDLE = 32, 44, 55  # um


def rings():
    """Cells of two rings as a CSV file, in circles 2 um apart."""
    rows = ["x,y,volume"]
    for r in np.arange(A + 1, B, 2):
        n = round(np.pi * r)
        for phi in 2 * np.pi * (np.arange(n) + 0.25 * ((r - A) % 4)) / n:
            rows += [f"{x + r * np.cos(phi):.6f},{r * np.sin(phi):.6f},{4 * np.pi * r / n:.8f}"
                     for x in (-MIDDLE, MIDDLE)]
    return "\n".join(rows) + "\n"


def two(runs, name, **ways):
    """A run with what fills the lumens a and b, and the law of each."""
    keys = {"Dimension": 2, "Time/End time": 1, "Time/Step": 0.25, "Tissue/Shape": "points",
            "Tissue/Points file": runs.write("rings.csv", rings()), "Tissue/Cell spacing": 2,
            "Grid/Spacing": 6, "Grid/Offset": "3, 1", "Lumens/Names": "a, b",
            "Lumens/a/Where": f"(X + {MIDDLE})^2 + Y^2 < 38^2",
            "Lumens/b/Where": f"(X - {MIDDLE})^2 + Y^2 < 38^2", "Output/Formats": "csv",
            **{f"Lumens/{lumen}": value for lumen, value in ways.items()}}
    run = runs.run(name, {key.replace("_", "/"): value for key, value in keys.items()})
    E, nu = 1, 0.4
    return run, Shell((E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))), 2, A, B)


@pytest.mark.parametrize("b", [{"b_Pressure": "0.1*t"}, {"b_Volume": "1 + t/2"},
                               {"b_Secretion": 7}])
def test_each_has_its_law(runs, b):
    """The pressure of each is that of its own ring at its volume."""
    run, shell = two(runs, "rings", a_Pressure="0.05*t", **b)
    last, first = run.statistics.iloc[-1], run.statistics.iloc[0]
    for lumen in "ab":
        p, V = (last[f"lumen_{what}_{lumen}"] for what in ("pressure", "volume"))
        V0 = first[f"lumen_volume_{lumen}"]
        assert V0 == pytest.approx(np.pi * A**2, rel=0.01)
        assert p == pytest.approx(shell.solved(V / V0)[0], rel=0.03)
        if lumen == "a" or "b_Pressure" in b:
            p0 = 0.05 if lumen == "a" else 0.1
            assert p * V / V0 == pytest.approx(p0, rel=1e-4)
    ratio = (run.statistics["lumen_volume_b"] / first["lumen_volume_b"]).to_numpy()
    t = run.statistics["time"].to_numpy()
    if "b_Volume" in b:
        np.testing.assert_allclose(ratio, 1 + t / 2, rtol=1e-7)
    if "b_Secretion" in b:
        np.testing.assert_allclose(ratio, (1 + 7 * t / A)**2, rtol=1e-3)
    rows = run.forces[run.forces["kind"] == "lumen"]
    assert list(rows["name"].iloc[-2:]) == ["a", "b"]


def test_they_merge(runs):
    """The septum of the example gives way, and the fluid of both stays."""
    whole = runs.run("merge", EXAMPLE, {"Output/Interval": 0.5, "Output/Formats": "csv"})
    assert whole.said.count("merged with") == 1
    table = whole.statistics
    volume = table["lumen_volume_left"] + table["lumen_volume_right"]
    assert volume.is_monotonic_increasing
    assert table["lumen_pressure_left"].iloc[-1] == table["lumen_pressure_right"].iloc[-1] > 0
    assert_same_run(whole, runs.resumed("parts", EXAMPLE, {
        "Output/Interval": 0.5, "Output/Formats": "csv"}, 2.5))
