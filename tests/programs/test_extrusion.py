# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Live extrusion and the present depth: homeostatic pressure, growth in a rim that stays
at the surface."""
import numpy
import pytest

BOX = {"Dimension": 2, "Time/End time": 4, "Time/Step": 0.1, "Tissue/Shape": "box",
       "Tissue/Size": "320, 320", "Tissue/Cell spacing": 8, "Grid/Spacing": 32,
       "Material/Relaxation time": 0.1, "Growth/Law": "rate", "Growth/Rate/Rate": 0.5,
       "Division by size/Volume": 92, "Division by size/Noise": 0.2,
       "Extrusion/Rate": "max(0, pressure)", "Boundary conditions/Slip where": 1,
       "Output/Formats": "csv", "Output/Interval": 0.5}
RIM = {"Time/End time": 2, "Tissue/Shape": "sphere", "Tissue/Radius": 100,
       "Tissue/Coarsen surface": "true",
       "Material/Relaxation time": 0.05,
       "Growth/Law": "rate", "Output/Formats": "none"}


def test_homeostatic_pressure(runs):
    run = runs.run("box", BOX)
    pressures = []
    for number in range(3, 9):  # from day 1.5 on
        cells = run.cells(number)
        grown = cells["volume"] / cells["elastic_volume_ratio"]
        trace = cells["sigma_xx"] + cells["sigma_yy"] + cells["sigma_zz"]
        pressures.append((-trace / 3 * grown).sum() / grown.sum())
    assert abs(numpy.mean(pressures) / 0.5 - 1) <= 0.05
    assert {*run.events[run.events["event"] == "death"]["cause"]} == {"extruded"}
    assert run.statistics["deaths"].sum() == run.statistics["removed"].sum()


# In 2-D dR/dt = b (w - w^2/2R), in 3-D dR/dt = b (R^3 - (R-w)^3)/3R^2. By the founder's
# depth it would be 127.223 and 122.506.
@pytest.mark.parametrize("dim, spacing, h, step, low, high, exact, within", [
    (2, 4, 14, 0.05, 18, 22, 118.162, 0.4), (3, 10, 30, 0.1, 15, 25, 116.526, 0.5)])
def test_rim(runs, dim, spacing, h, step, low, high, exact, within):
    run = runs.run(f"rim-{dim}", RIM, {
        "Dimension": dim, "Tissue/Cell spacing": spacing, "Grid/Spacing": h, "Time/Step": step,
        "Growth/Rate/Rate": f"0.5*(1 - ramp(present_depth, {low}, {high}))"})
    volume = run.statistics["grown_volume"].iloc[-1]
    ball = numpy.pi if dim == 2 else 4 * numpy.pi / 3
    assert abs((volume / ball) ** (1 / dim) - exact) <= within


@pytest.mark.parametrize("rate, says", [("200*max(0, pressure)", True), ("0.5*max(0, pressure)", False),
                                        ("20", False)])
def test_faster_than_the_steps(runs, rate, says):
    """A rate that follows the state must not empty a step; a constant one may."""
    run = runs.run("fast", BOX, {"Tissue/Size": "64, 64", "Time/End time": 0.5,
                                 "Extrusion/Rate": rate})
    assert ("times the step is" in run.said) == says


@pytest.mark.parametrize("keys, says", [({}, True), ({"Growth/Law": "none", "Division by size/Volume": 0}, False),
                                        ({"Extrusion/Rate": 0}, False)])
def test_slip_sides_hold_points(runs, keys, says):
    """Tissue that passes carries them away: that is said before the run."""
    run = runs.run("slips", BOX, {"Tissue/Size": "64, 64", "Time/End time": 0.1, **keys})
    assert ("not on the place" in run.said) == says
