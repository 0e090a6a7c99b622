# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Step 1: what the splines reproduce, and their condition numbers."""
import math

import pytest

from tests.common.steps import tables

pytestmark = pytest.mark.quick


def test_errors_and_condition_numbers(step):
    errors, conditions = tables(step({"Tissue/Cell spacing": "2"}))
    assert errors["unknowns"] == [16, 60, 176, 656]
    # Partition of unity and quadratics: rounding errors.
    assert max(errors["of 1"] + errors["of xy"]) < 1e-12
    # The third order, on average, and the values.
    wave = errors["of a wave"]
    assert math.log2(wave[0] / wave[-1]) / 3 > 3.0
    assert wave == pytest.approx([7.05e-2, 3.23e-3, 5.39e-4, 4.39e-5], rel=0.01)
    # Cells of 2 um see slivers of that size: without extension the smallest of 16 cuts
    # is unusable, with it no cut matters.
    assert len(conditions["offset"]) == 16
    assert max(conditions["plain"]) > 1e9
    assert max(conditions["extended"]) < 1e4
    assert max(conditions["extended, scaled"]) < 100.0
    for plain, extended in zip(conditions["plain, scaled"],
                               conditions["extended, scaled"]):
        assert extended < plain


def test_refusals(step):
    assert "2" in step({"Dimension": 3}, code=1)
    assert "--resume" in step({}, "--resume", code=1)
