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
   * cells do not touch. All ranks get the same answer without communication.
   */
  template <int dim>
  class PieceWatch
  {
  public:
    /**
     * Compares the pieces with those of the last call.
     * @return if two pieces have become one, the point (µm) in the middle
     *   between their nearest grid cells. Nothing in the first call.
     */
    std::optional<Point<dim>>
    joined(const SplineSpace<dim> &space);

  private:
    /** For each grid cell of the box of @p space, its piece in the last call,
     * if the grid cell was active then and is active now. */
    std::vector<unsigned int>
    former_pieces(const SplineSpace<dim> &space) const;

    GridBox<dim>              box;
    std::vector<unsigned int> pieces; // by grid cell
  };

  /** How many pieces of the tissue hold cells. All ranks get the same answer
   *  without communication. */
  template <int dim>
  unsigned int
  pieces_with_cells(const SplineSpace<dim> &space);
} // namespace Morula

#endif
