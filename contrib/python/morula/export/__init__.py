# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What others read of a run: morula export.

`tool` is the command. `tracks` makes the graph of all cells over time, and a lineage of such a
graph; `geff` writes and reads it. `h5ad` writes cells as annotated data, `vtkhdf` as points over
time. `rasters` fills voxels with the cells' regions, and `images` writes them. h5py, zarr and
tifffile do the work on files, each where it is asked for."""
