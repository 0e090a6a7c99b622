// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_classification_h
#define morula_grid_classification_h

#include <morula/grid/occupancy.h>

#include <vector>

namespace Morula
{
  /** The role of a grid cell for the splines (doc/theory.md, section 3). The
   *  order counts: see is_active(). */
  enum class GridCellClass : char
  {
    empty,
    /** Holds no points; only particles' cubes reach into it. It connects grid
     *  cells with tissue, and is otherwise treated like an empty one. */
    reached,
    cut,
    inner
  };

  /** Whether a grid cell holds a particle, a quadrature point or a boundary
   *  point. */
  inline bool
  is_active(const GridCellClass grid_cell)
  {
    return grid_cell >= GridCellClass::cut;
  }

  /** How far around a grid cell its class depends on others. */
  template <int dim>
  constexpr int
  reach_of_classes()
  {
    return TissueRows<dim>::reach + 1;
  }

  /**
   * Classifies the grid cells of this rank's window that are reach_of_classes()
   * inside of it; the others count as empty. An active grid cell is *inner* if
   *
   * - its fill is at least C_C min(1, largest fill of it and its neighbours):
   *   doc/theory.md (3.2). The minimum gives thin sheets and small clusters
   *   inner grid cells.
   * - in thin tissue, it is the candidate of its thin rows, see
   *   Occupancy::is_inner_candidate(). Then only such neighbours count in the
   *   rule above. Otherwise a thin body on both sides of a grid line would have
   *   inner grid cells whose outermost splines hardly touch it.
   * - it and its neighbours hold at least 3^dim quadrature points together,
   *   and, unless the tissue is thin, it holds 2^dim of them itself. With fewer
   *   points its splines could not be told apart.
   */
  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter);
} // namespace Morula

#endif
