# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of one scene with varied keys and seeds.

The way through the package: `program` is the executable, `scene` what a .prm
file says, `ladder` which keys take which values, `runner` runs what is not
there yet and measures what it costs, `results` reads what a run has written,
`org_tables` what a step program has printed; `command_line` and `style` are
what the programs that do this have in common.
Whoever only wants to look at a run that is there reads it with `run.Run`:
statistics, cells, surface and `lineage` as NumPy arrays.
Mistakes of the user raise `Refused`.
"""
