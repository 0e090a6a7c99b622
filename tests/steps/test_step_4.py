# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Step 4: errors against the reference, at a stretch of 1.1."""
import pytest

from tests.common.results import read_csv
from tests.common.steps import tables
from tests.steps.conftest import PRM


def test_errors(step):
    rows, = tables(step({"Time/End time": "1", "Tissue/Cell spacing": "25"}))
    exact = read_csv(PRM.parent / "doc/data/half-fixed-sphere.csv")[0]
    assert exact["theta"] == 1.1
    assert rows["clamp"] == 4 * ["symmetric"] + 4 * ["unsymmetric"]
    assert rows["h"] == 2 * [100, 75, 50, 37.5]
    assert rows["unknowns"] == sorted(rows["unknowns"][:4]) * 2
    for result, column, error in (("apex", "zmax", "error, %"),
                                  ("energy", "mean_energy_density", "error, % 2")):
        assert rows[error] == pytest.approx(
            [100 * (value / exact[column] - 1) for value in rows[result]], rel=0,
            abs=0.05)
    # The symmetric form with the large penalty is the worse one everywhere, and its
    # energy gets better with every refinement.
    energy = rows["error, % 2"]
    for symmetric, unsymmetric in zip(energy[:4], energy[4:]):
        assert symmetric > 3 * abs(unsymmetric)
    assert energy[:4] == sorted(energy[:4], reverse=True)
    # 5.6 % with two and a half grid cells to the radius, falling with h
    assert max(map(abs, energy[4:])) < 6
    assert max(map(abs, energy[6:])) < 1
    assert abs(rows["error, %"][-1]) < 0.2
    assert rows["energy"] == pytest.approx(
        [0.01743, 0.01597, 0.01469, 0.01418, 0.01354, 0.01320, 0.01292, 0.01294],
        rel=0.01)


def test_refusals(step):
    assert "1.150000" in step({"Time/End time": 1.5}, code=1)
    assert not step.output.exists()
