# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pools of like cells: pressures of capsules around growing cores, of bodies at rest,
and of mixtures, at any step."""
import numpy
import pytest

BALL = {"Dimension": 2, "Tissue/Shape": "sphere",
        "Growth/Law": "rate",
        "Cell types/Names": "soft, hard", "Output/Formats": "csv"}
HARD = "Cell types/hard/Material/Young's modulus"
CAPSULE = {**BALL, "Time/End time": 2, "Tissue/Radius": 80, "Tissue/Cell spacing": 2,
           "Grid/Spacing": 10, "Grid/Offset": "3, 1",
           "Material/Relaxation time": "if(type==hard, 0, 0.1)",
           "Cell types/hard/Where": "X^2 + Y^2 > 60^2", HARD: 10,
           "Growth/Rate/Rate": "0.5*(X^2 + Y^2 < 60^2)", "Output/Interval": 2}


def pressure(cells, radius=numpy.inf):
    """In the plane, kPa, of the cells within a radius."""
    inside = numpy.hypot(cells["x"], cells["y"]) < radius
    return -(cells["sigma_xx"] + cells["sigma_yy"])[inside] / 2


# The exact pressures are those of a neo-Hookean ring around a core without shear, whose
# grown volume is e times its first one: by quadrature of the ring's equation.
@pytest.mark.parametrize("step, stiffness, border, exact", [
    (0.4, 10, 60, 0.66277), (0.1, 10, 60, 0.66277), (0.1, 3, 60, 0.22464),
    (0.1, 100, 70, 2.05090)])
def test_capsule(runs, step, stiffness, border, exact):
    where = "X^2 + Y^2 {} " + f"{border}^2"
    run = runs.run(f"capsule-{step}-{stiffness}", CAPSULE, {
        "Time/Step": step, HARD: stiffness, "Cell types/hard/Where": where.format(">"),
        "Growth/Rate/Rate": f"0.5*({where.format('<')})"})
    core = pressure(run.cells(-1), 0.65 * border)
    assert abs(core.mean() / exact - 1) < 0.03
    assert core.std() < 0.026 * core.mean()


def test_capsule_on_ranks(runs):
    alone, shared = (runs.run(f"capsule-on-{n}", CAPSULE, {
        "Time/Step": 0.2, "Time/End time": 0.8}, ranks=n).cells(-1) for n in (1, 3))
    for axis in "xy":
        assert abs(alone[axis] - shared[axis]).max() < 1e-5


def test_elastic_body_keeps_its_pressure(runs):
    """The core of an elastic body grows until t = 0.5; then nothing happens."""
    run = runs.run("held", CAPSULE, {
        "Time/End time": 2, "Time/Step": 0.02, "Tissue/Cell spacing": 5, "Grid/Spacing": 15,
        "Material/Relaxation time": 0, "Output/Interval": 0.5,
        "Growth/Rate/Rate": "2*(t < 0.5)*(X^2 + Y^2 < 60^2)"})
    first, last = (pressure(run.cells(k), 45).mean() for k in (1, -1))
    assert abs(last / first - 1) < 0.005


def test_mixture_has_its_grown_volume(runs):
    """Soft cells that grow and hard ones stand side by side, free, and flow."""
    run = runs.run("mixed", BALL, {
        "Time/End time": 3, "Time/Step": 0.1, "Tissue/Radius": 60, "Tissue/Cell spacing": 5,
        "Grid/Spacing": 20, "Grid/Offset": "3, 1", "Material/Relaxation time": 0.2, HARD: 10,
        "Cell types/hard/Where": "sin(X*37.3 + 2*Y)*sin(Y*51.7 - X) > 0",
        "Growth/Rate/Rate": "0.4*(type == soft)", "Output/Interval": 3})
    row = run.statistics.iloc[-1]
    assert row["total_volume"] / row["grown_volume"] > 0.975
    assert numpy.sqrt((pressure(run.cells(-1))**2).mean()) < 0.15


def test_stress_vanishes_after_growth(runs):
    """A ring grows unevenly for a day, and rests for four relaxation times: the rms of
    the pressure falls from 0.02 kPa."""
    run = runs.run("rest", {**BALL, "Cell types/Names": ""}, {
        "Time/End time": 3, "Time/Step": 0.1, "Tissue/Radius": 100, "Tissue/Inner radius": 40,
        "Tissue/Cell spacing": 2, "Grid/Spacing": 10, "Grid/Offset": "3, 1.7",
        "Material/Relaxation time": 0.5, "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.4*min(t, 1)*(X^2 + Y^2)/10000",
        "Output/Interval": 3})
    assert numpy.sqrt((pressure(run.cells(-1))**2).mean()) < 1.2e-3


def test_explain_says_where_layers_are_thin(runs):
    text = runs.explain(CAPSULE, {"Cell types/hard/Where": "X^2 + Y^2 > 76^2"})
    assert "% of the tissue is layers or mixtures of cells" in text
    text = runs.explain(CAPSULE)
    assert "layers or mixtures" not in text
