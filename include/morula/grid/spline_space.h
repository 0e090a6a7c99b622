// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_spline_space_h
#define morula_grid_spline_space_h

#include <morula/grid/background_grid.h>
#include <morula/grid/bspline.h>
#include <morula/grid/extension.h>
#include <morula/grid/small_pieces.h>
#include <morula/grid/spline_copies.h>

#include <deal.II/base/index_set.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * The extended B-splines around the tissue for one step: which splines are
   * unknowns, their numbers over all ranks, and how the 3^dim splines of each
   * of this rank's active grid cells are expressed by unknowns.
   *
   * "Spline" here is one copy of a spline (see SplineCopies). An inner spline
   * is an unknown. An outer spline follows from the 3^dim unknowns of an inner
   * grid cell; where several serve equally well, it is the mean over them. The
   * splines of a small piece follow from one polynomial: a quadratic one if the
   * piece is smaller than a grid cell, an affine one if it is smaller than two
   * and has fewer than 3^dim particles, or has no inner grid cell. (A tensor
   * product of quadratics has monomials up to degree 2 dim, which nearly vanish
   * on a small piece.) An unknown is one number of a scalar field; fields of
   * several components have it for each (FieldUnknowns).
   */
  template <int dim>
  class SplineSpace
  {
  public:
    /** One of this rank's active grid cells. */
    struct GridCell
    {
      unsigned int number; // of the grid cell in the box
      /** Unknowns: positions in relevant(), increasing. */
      std::vector<unsigned int> unknowns;
      /** Splines (3^dim rows) by unknowns; empty where the unknowns are the
       *  splines themselves in order. */
      std::vector<double> weights;
    };

    /** Collective, though without communication. */
    SplineSpace(const BackgroundGrid<dim> &grid,
                Occupancy<dim>             occupancy,
                const GridParameters      &parameters);

    /** This rank's active grid cells, by number. */
    const std::vector<GridCell> &
    grid_cells() const;

    /** Unknown splines this rank owns. */
    const IndexSet &
    owned() const;

    /** Unknown splines that this rank's active grid cells use. */
    const IndexSet &
    relevant() const;

    /** Counts over all ranks. */
    unsigned int
    n_unknowns() const;
    unsigned int
    n_active_grid_cells() const;
    unsigned int
    n_inner_splines() const;
    unsigned int
    n_outer_splines() const;

    /** The piece that an active grid cell belongs to; see SplineCopies. */
    unsigned int
    piece(const unsigned int number) const;

    unsigned int
    n_pieces() const;

    const GridBox<dim> &
    box() const;

    const Occupancy<dim> &
    occupancy() const;

    /**
     * Coefficients of the affine field a + g·x in one piece, zero in the
     * others: of this rank's unknowns, in the order of owned(). Splines
     * reproduce affine fields: the coefficient is the field's value at the
     * spline's centre.
     * @param gradient g, per µm
     */
    std::vector<double>
    affine_coefficients(const unsigned int    piece,
                        const double          a,
                        const Tensor<1, dim> &gradient) const;

    /** The piece of each of this rank's unknowns, in the order of owned(). */
    const std::vector<unsigned int> &
    pieces_of_unknowns() const;

  private:
    using Terms = std::vector<std::pair<unsigned int, double>>;

    bool
    is_unknown(const SplineCopy &copy) const;
    void
    number_unknowns(const BackgroundGrid<dim> &grid);
    void
    express_grid_cells(const BackgroundGrid<dim> &grid);
    void
    add_grid_cell(const unsigned int number, const std::vector<Terms> &rows);
    void
    find_relevant();

    /** Global unknowns and weights of one spline. */
    Terms
    expression(const unsigned int copy, ExtensionSearch<dim> &search) const;

    Occupancy<dim>             occupancy_;
    GridBox<dim>               box_;
    bool                       extend;
    std::vector<GridCellClass> classes;
    SplineCopies<dim>          copies;
    std::vector<unsigned int>  numbers; // by copy: unknown's number
    std::vector<unsigned int>  pieces_of_unknowns_;
    std::map<unsigned int, PiecePolynomial<dim>> small_pieces;
    std::vector<GridCell>                        grid_cells_;
    IndexSet                                     owned_, relevant_;
    unsigned int                                 n_unknowns_ = 0;
    unsigned int                                 n_active    = 0;
    unsigned int                                 n_inner     = 0;
    unsigned int                                 n_outer     = 0;
  };
} // namespace Morula

#endif
