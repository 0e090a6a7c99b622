# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From a segmented image, or a tracker's table, to a scene: contrib/import.

The way through the package: `options` is the command line, `read` makes an array of labels of a
file, `labels` judges them, `surface` finds the smooth surface of the tissue and its cavities,
`table` reads trackers' tables, `types` gives cells their types, `writing` writes the files, and
`tool` does one after the other. scikit-image, SciPy and tifffile do the work on images."""
