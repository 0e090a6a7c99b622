# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Free tissue in which every second cell shrinks to 5 %: 0.525 of its volume.

The tissue has the sum of its cells' grown volumes, to the order of the step,
and every cell its own: those that shrink are small, the others stay.
"""
import sys

from tests.common.results import Results, agree

results = Results(sys.argv[1])
cells = results.last_cells()
shrunk = cells["growth_volume_ratio"] < 0.5
agree("share of cells that shrink", shrunk.mean(), 0.5, 1e-12)
ratio = cells["volume"] / cells["initial_volume"]
total = cells["volume"].sum() / cells["initial_volume"].sum()
print("volume:", total, "energy density:", cells["energy_density"].mean())
print("smallest and largest J_e:", cells["elastic_volume_ratio"].min(),
      cells["elastic_volume_ratio"].max())
agree("volume", total, 0.525, 0.005)
agree("mean volume of cells that shrink", ratio[shrunk].mean(), 0.05, 0.0015)
agree("mean volume of the others", ratio[~shrunk].mean(), 1, 0.01)
agree("volume of the tissue", results.statistics()[-1]["total_volume"],
      cells["volume"].sum(), 1e-9 * cells["volume"].sum())
