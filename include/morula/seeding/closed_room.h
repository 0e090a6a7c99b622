// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_closed_room_h
#define morula_seeding_closed_room_h

#include <morula/seeding/filling.h>
#include <morula/seeding/seeding.h>

namespace Morula
{
  /**
   * About how much room without cells a surface encloses, µm^dim: gaps and
   * cavities with room for a cell, which are narrower than what a surface
   * around points leaves open. On one rank, with all cells.
   * @param patches of a closed surface around the cells
   */
  template <int dim>
  double
  room_without_cells(const AllCells<dim>       &cells,
                     const SurfacePatches<dim> &patches);
} // namespace Morula

#endif
