// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_tissue_rows_h
#define morula_grid_tissue_rows_h

#include <morula/grid/grid_cell_contents.h>

#include <vector>

namespace Morula
{
  /**
   * How thick the tissue is, from the connected rows of grid cells with tissue
   * along each coordinate. A row's thickness is its volume divided by its
   * cross-section, the smallest rectangle around its tissue; a row of eight
   * grid cells or more is not thin along itself, so that no rank must know all
   * of it.
   *
   * Grid cells at the edge of a window have rows that are cut off. Everything
   * here is what one rank finds in GridWindow::inner(reach) of the window, but
   * for thickness(), which needs eight rings.
   */
  template <int dim>
  class TissueRows
  {
  public:
    static constexpr int reach = 4;

    TissueRows() = default;

    explicit TissueRows(const GridCellContents<dim> &contents);

    /** Smallest thickness of a grid cell's rows in units of h, at most 1. */
    float
    least_thickness(const unsigned int number) const
    {
      return thicknesses[number];
    }

    /** The largest of these among the grid cell and its neighbours with
     *  tissue, so that the tip of a large body is not thin. */
    float
    thickness(const unsigned int           number,
              const GridCellContents<dim> &contents) const;

    /** Number of directions in which the grid cell's row is shorter than
     *  1.5 h. */
    unsigned int
    n_thin(const unsigned int number) const
    {
      return n_thin_[number];
    }

    /** See Occupancy. */
    bool
    is_thin(const unsigned int           number,
            const GridCellContents<dim> &contents) const;

    /** See Occupancy. */
    bool
    is_inner_candidate(const unsigned int number) const
    {
      return candidates[number];
    }

  private:
    void
    measure(const std::vector<unsigned int> &row,
            const unsigned int               direction,
            const GridCellContents<dim>     &contents);

    std::vector<float> thicknesses; // of rows, in h, at most 1
    std::vector<float> lengths;     // of rows, in h; 2 where no row is thin
    std::vector<char>  n_thin_;     // number of directions with a thin row
    std::vector<char>  candidates;  // see is_inner_candidate()
  };
} // namespace Morula

#endif
