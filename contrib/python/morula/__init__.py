# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Reads, runs, draws and reports simulations of Morula.

Whoever only wants to look at a run that is there reads it with `run.Run`:
statistics, cells, surface and `lineage`.

`execute` starts the program, for all tools and tests. `program` is the
executable, `scene` what a .prm file says, `ladder` which keys take which
values, `kept_runs` runs what is not there yet, and `record` keeps what it
cost; `command_line` and `style` are what the tools have in common. Mistakes of
the user raise `refusal.Refused`. The tools: `report`, `render` (pictures, by
`draw`), `shapes`, `sweep`, `accuracy` and `migrate`; `__main__` starts them.
"""
