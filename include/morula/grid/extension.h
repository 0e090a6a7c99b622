// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_extension_h
#define morula_grid_extension_h

#include <morula/grid/bspline.h>
#include <morula/grid/spline_copies.h>

#include <array>
#include <vector>

namespace Morula
{
  /**
   * Extension weights of one direction: the three quadratic B-splines of a
   * block that starts at spline 0, continued to spline @p j:
   * e_i = Π_{m≠i} (j-m)/(i-m), i, m = 0, 1, 2: doc/theory.md (3.3).
   * Any quadratic with coefficients c_0, c_1, c_2 has c_j = Σ e_i c_i.
   */
  std::array<double, 3>
  extension_weights(const int j);

  /**
   * Weights of an outer spline with respect to the 3^dim splines of the inner
   * grid cell @p block (numbered as BSpline).
   */
  template <int dim>
  std::array<double, BSpline<dim>::n>
  extension_weights(const GridIndex<dim> &spline, const GridIndex<dim> &block);

  /**
   * Finds the inner grid cells whose splines an outer spline is expressed by.
   * Holds references: box and classes must outlive it.
   */
  template <int dim>
  class ExtensionSearch
  {
  public:
    ExtensionSearch(const GridBox<dim>               &box,
                    const std::vector<GridCellClass> &classes);

    /**
     * Among the inner grid cells connected to the copy's support through grid
     * cells with tissue (bodies across a gap must not be coupled) all that have
     * the smallest Σ|e|, by number. The sums are products of integers, so that
     * equal ones are equal to the last bit. Empty if no inner grid cell is
     * connected.
     */
    std::vector<unsigned int>
    blocks(const SplineCopy &copy);

  private:
    std::vector<unsigned int>
    connected(const SplineCopy &copy, const int radius);

    const GridBox<dim>               &box;
    const std::vector<GridCellClass> &classes;
    std::vector<char>                 reached; // scratch, all 0 between calls
  };
} // namespace Morula

#endif
