# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A column under a load that becomes stiff with time alone: nothing grows, flows or
changes its type. It keeps its strain, so all of it stiffens, or its stress. And
prm/examples/mineralising-plate.prm."""
from math import log

import pytest
from scipy.optimize import brentq

from tests.common.program import TESTS, assert_same_columns, assert_same_run
from tests.programs.test_cell_types import cauchy, same_stress

COLUMN = """
set Dimension = 2
subsection Time
  set End time = 3
  set Step     = 0.5
end
subsection Tissue
  set Shape        = box
  set Center       = 0, 50
  set Size         = 100, 100
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 20
end
subsection Boundary conditions
  set Slip where     = Y < 99
  set Pressure where = Y > 99
  set Pressure       = 0.2*min(1, t/0.5)
end
subsection Output
  set Formats = csv
end
"""


def height(E, nu=0.4):
    """That of the column between its walls, µm: the stretch at which the nominal
    stress mu (L - 1/L) + lambda ln L / L is the load."""
    mu, lame_lambda = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    return 100 * brentq(lambda L: mu * (L - 1 / L) + lame_lambda * log(L) / L + 0.2,
                        0.5, 1, xtol=1e-14)


@pytest.mark.parametrize("key, value, soft, stiff", [
    ("Young's modulus", "1 + 99*ramp(t, 1, 2)", (1, 0.4), (100, 0.4)),
    ("Poisson's ratio", "0.3 + 0.1*ramp(t, 1, 2)", (1, 0.3), (1, 0.4))])
def test_stiffness_of_time_alone(runs, key, value, soft, stiff):
    run = runs.run(key.split()[0], COLUMN, {f"Material/{key}": value})
    top = run.statistics.set_index("time")["ymax"]
    assert top[1.0] == pytest.approx(height(*soft), rel=1e-4)
    assert top[3.0] == pytest.approx(height(*stiff), rel=1e-4)


# What is laid down bears nothing yet: the column stays, and gives way to more load
# as a stiff one.
KEPT = {"Material/On transition": "keep stress", "Time/Step": 0.1,
        "Material/Young's modulus": "1 + 99*ramp(t, 1, 2)", "Output/Interval": 0.5,
        "Boundary conditions/Pressure": "0.2*min(1, t/0.5) + 0.2*ramp(t, 2, 2.4)",
        "Solver/Newton tolerance": 1e-10}


@pytest.mark.parametrize("form, by", [
    ("pooled", "t"), ("pointwise", "t"), ("pooled", "age")])
def test_what_is_laid_down_bears_nothing(runs, form, by):
    run = runs.run(f"kept-{form}-{by}", COLUMN, {
        **KEPT, "Material/Volumetric strain": form,
        "Material/Young's modulus": f"1 + 99*ramp({by}, 1, 2)"})
    top = run.statistics.set_index("time")["ymax"]
    soft = height(1) / 100
    a, c = same_stress((1, soft), 1, 100)
    later = brentq(lambda r: cauchy((a, c * r), 100)[1] + 0.4, 0.9, 1, xtol=1e-14)
    assert top[1.0] == pytest.approx(100 * soft, abs=2e-3)
    assert top[2.0] == pytest.approx(top[1.0], abs=2e-3)
    assert top[3.0] - top[2.0] == pytest.approx(100 * soft * (later - 1), abs=1e-3)
    assert 100 * soft * (later - 1) == pytest.approx(-0.086, abs=1e-3)


def test_in_three_dimensions(runs):
    """As by the small strains that are added to a stiff column."""
    top = runs.run("kept-3d", COLUMN, {
        **KEPT, "Dimension": 3, "Tissue/Center": "0, 0, 50", "Tissue/Size": "40, 40, 100",
        "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Boundary conditions/Slip where": "Z < 99",
        "Boundary conditions/Pressure where": "Z > 99"}).statistics.set_index("time")["zmax"]
    assert top[2.0] == pytest.approx(top[1.0], abs=5e-3)
    assert top[3.0] - top[2.0] == pytest.approx(-0.0855, abs=1e-3)


PLATE = TESTS.parent / "prm/examples/mineralising-plate.prm"


def test_mineralising_plate(runs):
    """It grows as fast as without the load, within what a row of cells makes."""
    run = runs.run("plate", PLATE, {"Tissue/Size": "60, 300", "Output/Formats": "csv"})
    top = run.statistics.set_index("time")["ymax"]
    assert (top[4.0] - top[2.0]) / 2 == pytest.approx(394, rel=0.03)


def test_on_ranks_and_resumed(runs):
    """Cells of a column turn to bone one by one, and flow before."""
    keys = {**KEPT, "Cell types/Names": "soft, bone", "Time/End time": 1.2,
            "Tissue/Cell spacing": 10, "Grid/Spacing": 40,
            "Cell types/soft/Transitions/To bone": "3*(t > 0.5)",
            "Cell types/soft/Material/Young's modulus": 1,
            "Cell types/soft/Material/Relaxation time": 0.3,
            "Material/Young's modulus": "1 + 99*ramp(type_age, 0, 0.3)", "Output/Interval": 0.6}
    one, two = (runs.run(f"ranks-{ranks}", COLUMN, keys, ranks=ranks) for ranks in (1, 2))
    assert 10 < one.statistics["cells_bone"].iloc[-1] < 99
    assert_same_columns(*(run.directory / "cells-0002.csv" for run in (one, two)), {
        column: 1e-6 for column in one.cells(2)})
    assert_same_run(one, runs.resumed("parts", COLUMN, keys, 0.6))
