# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From a segmented image, or a tracker's table, to a scene: morula import.
`options`, `read`, `labels` and `surface`, or `table`, `types` and `writing`, one after the other."""
