// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_nearest_h
#define morula_particles_nearest_h

#include <morula/grid/background_grid.h>
#include <morula/particles/point_list.h>

#include <vector>

namespace Morula
{
  /**
   * The properties of the point nearest to each query position, over all ranks
   * (ties: the lowest id). Queries lie in grid cells of this rank. Returns
   * points.n_slots numbers for each query. Collective.
   */
  template <int dim>
  std::vector<double>
  nearest_properties(const std::vector<Point<dim>> &queries,
                     const PointList<dim>          &points,
                     const BackgroundGrid<dim>     &grid);
} // namespace Morula

#endif
