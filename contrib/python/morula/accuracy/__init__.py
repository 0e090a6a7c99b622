# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Accuracy against time: morula accuracy.

The way through the package: `options` is the command line and `request` checks it. The error bar:
`further` does the runs, `bar` adds up what they say. Ladders: `reference` is what a file knows of
the right values, `limits` where a ladder tends to, `estimate` the errors and what is known of
them, `findings` all of that together, `report` the tables and `figure` the picture."""
