# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Step 2: the errors against the exact solution, and their orders."""
import pytest

from tests.common.steps import tables


def test_orders(step):
    """Third order of displacement and gap, second of its gradient. Coarse grids do
    better than that, so that the mean rate is above it, too."""
    errors, = tables(step())
    assert errors["cells"] == [1976, 7860, 31428, 125676]
    rates = errors["displacement rate"][1:]
    assert sum(rates) / len(rates) > 3
    assert min(rates) > 2.6
    assert min(errors["gap rate"][1:]) > 2.7
    assert min(errors["deformation rate"][1:]) > 1.85
    assert errors["displacement"] == pytest.approx(
        [0.8406, 0.05699, 5.961e-3, 9.171e-4], rel=0.01)
    assert errors["deformation"] == pytest.approx(
        [3.385e-2, 5.675e-3, 1.312e-3, 3.511e-4], rel=0.01)


@pytest.mark.release
def test_few_cells(step):
    """Five cells to a grid spacing are the limit on the finest grid."""
    errors, = tables(step({"Tissue/Cell spacing": "20"}))
    assert errors["displacement rate"][-1] < 2.5
