// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_piece_watch_h
#define morula_grid_piece_watch_h

#include <morula/grid/spline_space.h>

#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Notices when two pieces of the tissue begin to share a spline. From then on
   * they stick together, at a distance of up to a grid spacing, though their
   * cells do not touch. A rank remembers the pieces of its own grid cells. All
   * ranks get the same answer.
   */
  template <int dim>
  class PieceWatch
  {
  public:
    /**
     * Compares the pieces with those of the last call. Collective.
     * @param grid on which @p space stands
     * @return if two pieces have become one, the point (µm) in the middle
     *   between their nearest grid cells. Nothing in the first call.
     */
    std::optional<Point<dim>>
    joined(const SplineSpace<dim> &space, const BackgroundGrid<dim> &grid);

  private:
    /** A grid cell and its piece in the last call. */
    struct Former
    {
      GridIndex<dim> grid_cell;
      unsigned int   piece, body;
    };

    /** What all ranks remember of this rank's grid cells. Collective. */
    std::vector<Former>
    former_pieces(const BackgroundGrid<dim> &grid) const
    {
      // Grid cells may have changed their owners since the last call. What this
      // rank remembers is told to the owners of now.
      std::map<unsigned int, std::vector<Former>> by_owner;
      for (const Former &one : remembered)
        if (grid.box().contains(one.grid_cell))
          by_owner[grid.owner(one.grid_cell)].push_back(one);
      return in_one(send_records(by_owner, grid.communicator()));
    }

    std::vector<Former> remembered;   // of grid cells that were this rank's
    unsigned int        n_pieces = 0; // in the last call
  };

  /** How many pieces of the tissue hold cells. Collective. */
  template <int dim>
  unsigned int
  pieces_with_cells(const SplineSpace<dim> &space, const MPI_Comm comm);
} // namespace Morula

#endif
