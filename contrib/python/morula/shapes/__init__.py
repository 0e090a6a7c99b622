# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The shapes of cells: Voronoi regions, cut off at the tissue's surface. Lengths are
in um. In two dimensions a region is a prism 1 um thick, as the volumes of a run are
per um of thickness: everything here knows 3-D alone."""
