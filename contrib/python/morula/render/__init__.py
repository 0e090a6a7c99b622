# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pictures and films of a run's cells, for morula render.

`tool` is the command and `request` what it is asked for; `frames` makes the picture of a state,
`composition` puts panels, scales and words together, `films` writes pictures one after the other.
"""
