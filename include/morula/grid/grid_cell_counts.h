// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_cell_counts_h
#define morula_grid_grid_cell_counts_h

#include <morula/grid/grid_box.h>
#include <morula/grid/grid_owners.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /** How many points a grid cell holds. */
  struct GridCellCount
  {
    unsigned int number; // of the grid cell in the box
    unsigned int n;

    bool
    operator==(const GridCellCount &other) const
    {
      return number == other.number && n == other.n;
    }
  };

  /** Counts of grid cells, in the order of their numbers. Grid cells that are
   *  not among them hold nothing. */
  using GridCellCounts = std::vector<GridCellCount>;

  /**
   * The counts of this rank's grid cells, summed over all ranks. Collective.
   * @param counts of any grid cells of the box, in any order; a grid cell may
   *   be among them several times
   */
  template <int dim>
  GridCellCounts
  sum_at_owners(const GridCellCounts  &counts,
                const GridBox<dim>    &box,
                const GridOwners<dim> &owners,
                const MPI_Comm         comm);
} // namespace Morula

#endif
