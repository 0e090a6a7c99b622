// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_extension_h
#define morula_grid_extension_h

#include <morula/grid/bspline.h>
#include <morula/grid/occupancy.h>
#include <morula/grid/spline_copies.h>

#include <array>
#include <vector>

namespace Morula
{
  /**
   * Extension weights of one direction. They express the coefficient of spline
   * @p j by those of the three splines 0, 1, 2 of a block:
   * e_i = Π_{m≠i} (j-m)/(i-m), i, m = 0, 1, 2: doc/theory.md (3.3).
   * A quadratic function with coefficients c_0, c_1, c_2 has c_j = Σ e_i c_i.
   */
  std::array<double, 3>
  extension_weights(const int j);

  /**
   * Weights that express an outer spline by the 3^dim splines of the inner grid
   * cell @p block, in the order of BSpline.
   */
  template <int dim>
  std::array<double, BSpline<dim>::n>
  extension_weights(const GridIndex<dim> &spline, const GridIndex<dim> &block);

  /**
   * Finds the inner grid cells by whose splines an outer spline is expressed.
   * It keeps references: occupancy and classes must outlive it.
   */
  template <int dim>
  class ExtensionSearch
  {
  public:
    ExtensionSearch(const Occupancy<dim>             &occupancy,
                    const std::vector<GridCellClass> &classes);

    /**
     * The inner nodes with the smallest Σ|e|, in the order of their numbers.
     * Only those count that grid cells with tissue connect to the
     * copy's support: bodies across a gap must not be coupled. The sums are
     * products of integers, so that equal sums are equal to the last bit. Grid
     * cells that extrapolate in the same directions by the same distances form
     * a group. Of several groups the fullest is taken; where the fills of
     * several agree to 1e-6, all of these. So the choice turns with the tissue.
     * The list is empty if no inner grid cell is connected, or where the window
     * of this rank is too narrow to tell.
     * @param center  the grid cell that the copy's spline is centred on
     * @param support the active nodes of the copy
     */
    std::vector<unsigned int>
    blocks(const GridIndex<dim>            &center,
           const std::vector<unsigned int> &support);

    /** Whether some search has met the window's edge. */
    bool
    needs_wider_window() const
    {
      return met_edge;
    }

  private:
    std::vector<unsigned int>
    connected(const GridIndex<dim>            &center,
              const std::vector<unsigned int> &support,
              const int                        radius);
    std::vector<unsigned int>
    fullest(const GridIndex<dim>            &spline,
            const std::vector<unsigned int> &blocks) const;

    const Occupancy<dim>             &occupancy;
    const GridNodes<dim>             &nodes;
    const std::vector<GridCellClass> &classes;
    std::vector<char>                 reached; // scratch, all 0 between calls
    bool                              met_edge = false;
  };
} // namespace Morula

#endif
