// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_classification_h
#define morula_grid_classification_h

#include <morula/grid/occupancy.h>

#include <vector>

namespace Morula
{
  /** What a grid cell is to the splines (doc/theory.md, section 3), in
   *  increasing order. */
  enum class GridCellClass : char
  {
    empty,
    /** Without points of its own; only boxes of particles reach into it. It
     *  connects grid cells, and is otherwise like an empty one. */
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

  /**
   * Classifies the grid cells of the box. *Inner* is an active grid cell
   *
   * - whose fill is at least C_C min(1, largest fill among it and its
   *   neighbours), doc/theory.md (3.2); the minimum lets thin sheets and small
   *   clusters have inner grid cells;
   * - that, in thin tissue, leads its rows across (only such
   *   neighbours count above, then): else a body on both sides of a grid line
   *   would have inner grid cells whose outermost splines hardly touch it;
   * - and that holds, together with its neighbours, at least 3^dim quadrature
   *   points, 2^dim of them itself unless the tissue is thin: fewer cannot tell
   *   its splines apart.
   */
  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter);
} // namespace Morula

#endif
