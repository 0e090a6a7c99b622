# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
# ranks: 1 2
"""Step 3: free growth is exact, and stresses balance where it is not free."""
import re

import pytest

from tests.common.steps import tables


def distance(text):
    return float(re.search(r"free growth: (\S+) um", text)[1])


@pytest.mark.quick
def test_uniform_growth(step):
    text = step()
    rows, = tables(text)
    assert rows["height"] == pytest.approx([200 + 20 * t for t in range(6)], rel=0,
                                           abs=1e-4)
    assert rows["volume/grown"] == pytest.approx([1.0] * 6, rel=0, abs=1e-6)
    assert max(rows["energy"]) < 1e-14
    assert max(rows["stress"]) < 1e-9
    assert distance(text) < 1e-7


def test_resume(step):
    step({"Time/End time": "2"})
    text = step({}, "--resume")
    rows, = tables(text)
    assert rows["day"] == [2, 3, 4, 5]
    assert distance(text) < 1e-7
    rows, = tables(step({}, "--resume"))
    assert rows["day"] == [5]


def test_growing_top(step):
    text = step({"Growth/Isotropic/Stretch": "1 + 0.1*t*(Z > 100)"})
    rows, = tables(text)
    assert min(rows["energy"][1:]) > 1e-4
    assert distance(text) > 1.0
    for pressure, stress in zip(rows["pressure"][1:], rows["stress"][1:]):
        # The plane is held up to a small gap.
        assert abs(pressure) < 1e-4 * stress
