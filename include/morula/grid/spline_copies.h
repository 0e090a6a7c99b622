// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_spline_copies_h
#define morula_grid_spline_copies_h

#include <morula/grid/bspline.h>
#include <morula/grid/classification.h>

#include <cstdint>
#include <vector>

namespace Morula
{
  /** The copy of a spline that one part of the tissue in its support uses. */
  struct SplineCopy
  {
    unsigned int spline; // number of the grid cell it is centred on
    /** The active grid cells of the part. Bit a stands for the grid cell at the
     *  spline's centre + BSpline::offset(a). */
    std::uint32_t support;
    bool          inner; // whether an inner grid cell is among them
    unsigned int  piece; // see SplineCopies
  };

  /**
   * The splines around the tissue. A spline reaches over 3^dim grid cells. If
   * those with tissue form parts that do not touch each other, each part has
   * its own copy of the spline. (Grid cells touch if they share a vertex.) So
   * bodies, or arms of one body, with an empty layer of grid cells between them
   * do not feel each other (doc/theory.md, section 3.3).
   *
   * Grid cells that share a copy belong to the same *piece*. All ranks compute
   * the same, without communication.
   */
  template <int dim>
  class SplineCopies
  {
  public:
    SplineCopies() = default;

    SplineCopies(const GridBox<dim>               &box,
                 const std::vector<GridCellClass> &classes);

    /** All copies, in the order of their splines; copies of one spline in the
     *  order of their lowest grid cells. */
    const std::vector<SplineCopy> &
    list() const;

    /** The copy of the spline centred on @p spline that the active grid cell
     *  @p grid_cell of its support uses: a position in list(). */
    unsigned int
    at(const GridIndex<dim> &spline, const GridIndex<dim> &grid_cell) const;

    /** The piece of the active grid cell @p number: 0, ..., n_pieces() - 1 in
     *  the order of the pieces' lowest grid cells. */
    unsigned int
    piece(const unsigned int number) const;

    unsigned int
    n_pieces() const;

    /** Lowest grid cell of a piece. */
    unsigned int
    lowest_grid_cell(const unsigned int piece) const;

  private:
    void
    add_copies(const unsigned int                spline,
               const std::vector<GridCellClass> &classes);
    void
    find_pieces();

    GridBox<dim>              box;
    std::vector<SplineCopy>   copies;
    std::vector<unsigned int> first;  // copy of each spline, and the end
    std::vector<unsigned int> pieces; // by grid cell
    std::vector<unsigned int> lowest; // by piece
  };
} // namespace Morula

#endif
