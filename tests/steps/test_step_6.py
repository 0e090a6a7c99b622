# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Step 6: what the size checkpoint holds, and where."""
import pytest

from tests.common.results import read_csv
from tests.common.steps import tables


def test_checkpoint(step):
    whole, layers = tables(step({"Tissue/Cell spacing": "40", "Grid/Spacing": "100",
                                 "Time/End time": "2.5"}))
    assert whole["J_th"] == [0, 0.8, 0.9]
    assert whole["waiting"][0] == 0
    assert min(whole["waiting"][1:]) > 10
    # The larger the threshold, the fewer the cells, and the lower the energy.
    for name in ("cells", "energy", "apex"):
        assert whole[name] == sorted(whole[name], reverse=True)
    assert min(whole["smallest J_e"][1:]) > whole["smallest J_e"][0]

    def of_thresholds(column):
        return [layers[column][i:i + 5] for i in (0, 5, 10)]

    assert layers["layer"] == [4, 3, 2, 1, 0] * 3
    founders = of_thresholds("founders")
    assert founders[0] == founders[1] == founders[2]
    per_founder, J_e = of_thresholds("cells per founder"), of_thresholds("J_e")
    for n, cells in zip(per_founder, whole["cells"]):
        assert abs(sum(a * b for a, b in zip(n, founders[0])) - cells) <= 1
    # Without checkpoint all layers are alike; with it, those that are held at their
    # surface divide less, and are less squeezed.
    assert max(per_founder[0]) / min(per_founder[0]) < 1.15
    for i in (1, 2):
        assert per_founder[i][4] < 0.9 * per_founder[0][4]
        assert J_e[i][4] > J_e[0][4]

    table = read_csv(step.output / "layers.csv")
    assert len(table) == 15
    assert table["cells_per_founder"] == pytest.approx(layers["cells per founder"],
                                                       rel=0, abs=1e-4)
