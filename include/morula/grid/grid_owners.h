// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_owners_h
#define morula_grid_grid_owners_h

#include <morula/grid/grid_box.h>

#include <deal.II/distributed/tria.h>

#include <cstdint>
#include <vector>

namespace Morula
{
  /**
   * Which rank owns which grid cell, without a table of the grid cells. The
   * ranks share the leaves of the octrees in the order of the trees (Morton
   * order). So the first leaf of every rank says who owns any grid cell: one
   * number a rank, however many grid cells there are.
   */
  template <int dim>
  class GridOwners
  {
  public:
    /** Two octrees of grid cells, which follow one another in one direction. */
    struct Trees
    {
      GridIndex<dim> first; // the grid cell with the smallest coordinates
      unsigned int   split; // the direction from the first tree to the second
      int            n_levels; // a tree has 2^n_levels grid cells per direction
    };

    /** All grid cells belong to rank 0. */
    GridOwners() = default;

    /**
     * Gathers the first leaves of all ranks. Collective.
     * @param tria leaves of @p trees, distributed over the ranks
     * @param box  has the same grid lines
     */
    GridOwners(const parallel::distributed::Triangulation<dim> &tria,
               const GridBox<dim>                              &box,
               const Trees                                     &trees);

    /** Rank that owns a grid cell of the trees. */
    unsigned int
    operator()(const GridIndex<dim> &grid_cell) const;

  private:
    /** Place of a grid cell in the order of the trees' leaves. */
    std::uint64_t
    key(GridIndex<dim> grid_cell) const;

    Trees                      trees{};
    bool                       second_tree_first = false;
    std::vector<std::uint64_t> first_keys; // by rank; empty on one rank
  };
} // namespace Morula

#endif
