// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_range_h
#define morula_grid_grid_range_h

#include <morula/grid/grid_box.h>

#include <vector>

namespace Morula
{
  /** Grid cells from one to another in each direction, both included; none if
   *  the last lies before the first. */
  template <int dim>
  struct GridRange
  {
    GridIndex<dim> first, last;

    /** Whether there is no grid cell in it. */
    bool
    empty() const;

    /** Whether the grid cell is one of them. */
    bool
    contains(const GridIndex<dim> &index) const;

    /** Makes it the smallest that holds the other one, too. */
    void
    unite(const GridRange &other);

    /** The range, with @p rings more grid cells on all sides but inside of @p
     *  box. */
    GridRange
    grown(const int rings, const GridBox<dim> &box) const;

    /** Layers of grid cells between the two; 0 if they touch, less if they
     *  have grid cells in common. */
    int
    gap(const GridRange &other) const;
  };

  /**
   * Ranges that hold all of these, where more than @p gap layers lie between
   * any two. There are at most 32, as whoever looks for a grid cell looks into
   * each of them: of more, those with less than 2, 4, 8, ... gaps between them
   * share one.
   */
  template <int dim>
  std::vector<GridRange<dim>>
  separated(const std::vector<GridRange<dim>> &ranges, int gap);
} // namespace Morula

#endif
