# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The figures and numbers of Yokoyama, Kameo & Adachi (2023), doi:10.1016/j.jmbbm.2023.105828,
from runs of the scenes in prm/paper.

Lengths are in µm, times in days, energy densities in kPa."""
