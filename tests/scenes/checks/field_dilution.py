# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A uniform field in tissue that grows: c = c_0 / J."""
import sys

from tests.common.results import Results, agree

results = Results(sys.argv[1])
cells = results.last_cells()
J = cells["volume"] / cells["initial_volume"]
agree("growth", J, 1.2**3, 1e-6)
agree("the field times J, relative",
      cells["diluted"] * J / results.number("Fields/diluted/Initial"), 1, 1e-7)
agree("the field without dilution, relative",
      cells["kept"] / results.number("Fields/kept/Initial"), 1, 1e-9)
rows = results.statistics()
agree("mean of the field in statistics.csv, relative",
      rows["diluted_mean"][-1] * 1.2**3 / 2, 1, 1e-7)
agree("clipped values", rows["diluted_clipped"], 0, 0)
