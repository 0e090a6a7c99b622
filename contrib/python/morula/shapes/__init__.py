# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The shapes of cells: Voronoi regions, cut off at the tissue's surface.

polyhedra      many polyhedra in a few arrays, their volumes and walls
voronoi        the regions of all cells, uncut
cutting        a plane through each of many polyhedra at once
boundary       which planes the boundary points put through which region
regions        all of it for a state of a run
grid, writing  as an unstructured grid of VTK, as files
condition      the expression of --where
tool           the command contrib/cell-shapes

Lengths are in um. In two dimensions a region is a prism 1 um thick, as the
volumes of a run are per um of thickness: everything here knows 3-D alone.
"""
