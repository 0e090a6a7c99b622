# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Step 5: the doubled cube, and the expected number of divisions."""
import math
import re

import pytest

from tests.common.steps import tables

pytestmark = pytest.mark.quick


def test_divisions(step):
    text = step({"Tissue/Cell spacing": "20", "Tissue/Boundary points": "0"})
    together, random = tables(text)
    assert together["cells"] == [1000, 1000, 2000, 2000, 2000]
    assert together["height"] == pytest.approx([200, 290, 300, 310, 400], rel=0,
                                               abs=1e-6)
    assert max(together["energy"]) < 1e-14
    assert float(re.search(r"error of the height: (\S+) um", text)[1]) < 1e-8

    assert random["seed"] == [1, 2, 3]
    p = 1 - math.exp(-1)
    deviation = math.sqrt(1000 * p * (1 - p))
    for n, cells, deviations, n_z in zip(random["divisions"], random["cells"],
                                         random["deviations"], random["n_z^2"]):
        assert cells == 1000 + n
        assert abs(n - 1000 * p) < 4 * deviation
        assert abs(deviations - (n - 1000 * p) / deviation) <= 0.01
        # The variance of n_z^2 is 4/45; some 1,000 cells cycle.
        assert abs(n_z - 1 / 3) <= 0.05
    assert len(set(random["divisions"])) > 1


def test_refusals(step):
    assert "Time/End time" in step({"Time/End time": 2}, code=1)
