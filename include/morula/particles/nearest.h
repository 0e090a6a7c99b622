// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_nearest_h
#define morula_particles_nearest_h

#include <morula/grid/background_grid.h>
#include <morula/particles/point_store.h>

#include <functional>
#include <vector>

namespace Morula
{
  /** What is wanted of a point, given by its position in PointStore::order():
   *  append(p, list) adds @p n numbers to the list. Of several points that are
   *  equally near the mean, which is the same in any frame, or else what is
   *  wanted of the one with the lowest id. */
  struct WantedProperties
  {
    unsigned int                                             n;
    std::function<void(unsigned int, std::vector<double> &)> append;
    bool                                                     mean_of_ties;
  };

  /**
   * What is wanted of the point nearest to each query position, over all ranks,
   * one after the other. Queries lie in grid cells of this rank. Asks only for
   * points near any query. Collective.
   */
  template <int dim>
  std::vector<double>
  nearest_properties(const std::vector<Point<dim>> &queries,
                     const PointStore<dim>         &points,
                     const WantedProperties        &wanted,
                     const BackgroundGrid<dim>     &grid);
} // namespace Morula

#endif
