# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Founders begin in the generation and the phase that their file says, and divide
when that phase lets them: with T = 2 days and nobody leaving G0, those in S in
(0.5, 1] day and those in G2 in (0, 0.5], once; nobody else does.
"""
import sys
from pathlib import Path

import numpy
from morula.run import read_csv

from tests.common.results import Results, agree

results = Results(sys.argv[1])
file = numpy.genfromtxt(
    Path(__file__).parents[1] / results.keys["Tissue/Points file"],
    delimiter=",", names=True, dtype=None, encoding="utf-8")
first = read_csv(results.outputs("cells")[0])
assert list(first["id"]) == list(range(len(file)))
agree("phases at t = 0", first["phase"], file["phase"], 0)
agree("generations at t = 0", first["generation"], file["generation"], 0)
agree("growth at t = 0", first["growth_volume_ratio"], 1, 1e-12)

lineage = results.lineage()
founders = lineage[lineage["parent"] < 0]
agree("generations of founders", founders["generation"], file["generation"], 0)
types = numpy.isin(file["type"], ["transit", "1"])
assert 40 < types.sum() < 90
agree("types of founders", founders["type"], types, 0)
daughters = lineage[lineage["parent"] >= 0]
mothers = daughters["parent"].astype(int)
agree("generations of daughters", daughters["generation"],
      file["generation"][mothers] + 1, 0)
agree("types of daughters", daughters["type"],
      types[mothers] | (daughters["id"] % 2 == daughters["id"].max() % 2), 0)
for phase, begin, end in ((1, 0.5, 1), (2, 0, 0.5)):
    divided = numpy.flatnonzero(file["phase"] == phase)
    times = daughters["birth_time"][numpy.isin(mothers, divided)]
    assert len(times) == 2 * len(divided), (phase, len(times))
    assert begin < times.min() and times.max() <= end, (phase, times)
    # all over the phase
    assert times.max() - times.min() > 0.6 * (end - begin), (phase, times)
assert set(file["phase"][mothers]) == {1, 2}

# Those in G1 grow on, from 1.5 to 2 of a resting cell at most, and rest.
last = results.last_cells()
resting = numpy.isin(last["id"], numpy.flatnonzero(file["phase"] == 4))
growth = last["growth_volume_ratio"][resting]
assert (growth > 1).all() and (growth <= 2 / 1.5 + 1e-9).all(), growth
agree("phases of those in G1 at T/2", last["phase"][resting], 0, 0)
