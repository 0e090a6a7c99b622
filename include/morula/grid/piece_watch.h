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
   * Notices when parts of the tissue that shared no spline begin to share one:
   * from then on they stick together, at a distance of up to a grid spacing,
   * though their cells do not touch. The same on all ranks, without
   * communication.
   */
  template <int dim>
  class PieceWatch
  {
  public:
    /**
     * Compares the pieces with those of the call before: where two of them have
     * become one, the point (µm) in the middle between their grid cells that
     * are nearest to each other. None in the first call.
     */
    std::optional<Point<dim>>
    joined(const SplineSpace<dim> &space);

  private:
    /** By number in the box of @p space: the piece that a grid cell belonged to
     *  in the call before, if it was and is active. */
    std::vector<unsigned int>
    former_pieces(const SplineSpace<dim> &space) const;

    GridBox<dim>              box;
    std::vector<unsigned int> pieces; // by grid cell
  };
} // namespace Morula

#endif
