# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Ensembles of runs: morula sweep.

The way through the package: `options` is the command line, `request` checks it, `ensemble` what
the seeds of one combination have in common, `report` and `figure` the tables and the picture."""
