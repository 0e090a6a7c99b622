// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_unknown_numbers_h
#define morula_grid_unknown_numbers_h

#include <morula/grid/background_grid.h>
#include <morula/grid/bspline.h>
#include <morula/grid/occupancy.h>
#include <morula/grid/spline_copies.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/numbers.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * The polynomial from which the splines of a small piece follow: Σ c_m m(ξ)
   * over the monomials m of ξ = (x - center)/h up to degree 1 or 2. Each
   * monomial has one unknown c_m: doc/theory.md (3.4).
   */
  template <int dim>
  struct PiecePolynomial
  {
    Point<dim>   center; // µm
    bool         quadratic;
    unsigned int first_unknown = numbers::invalid_unsigned_int;

    unsigned int
    n_unknowns() const
    {
      return quadratic ? (dim + 1) * (dim + 2) / 2 : dim + 1;
    }

    /** The unknowns of the spline centred at @p x (µm) and their weights.
     *  @param h grid spacing, µm */
    std::vector<std::pair<unsigned int, double>>
    expression(const Point<dim> &x, const double h) const;
  };

  /**
   * The small pieces of all ranks and their polynomials, without numbers of
   * unknowns. Collective. Small
   * is a piece without an inner grid cell, a piece smaller than h in every
   * direction, and a piece smaller than 2h with fewer than 3^dim particles. The
   * polynomial is quadratic if the piece is smaller than h and has at least
   * 3^dim particles, otherwise affine.
   */
  template <int dim>
  std::map<unsigned int, PiecePolynomial<dim>>
  find_small_pieces(const Occupancy<dim>             &occupancy,
                    const std::vector<GridCellClass> &classes,
                    const SplineCopies<dim>          &copies,
                    const MPI_Comm                    comm);

  /**
   * The numbers of the unknowns over all ranks. They run rank by rank, since an
   * unknown belongs to the rank that owns the grid cell on which its spline
   * stands: on each rank first the splines in the order of the grid's box, then
   * the unknowns of small pieces. A rank knows the numbers of its own unknowns,
   * and of those that it has asked for.
   */
  template <int dim>
  class UnknownNumbers
  {
  public:
    using SmallPieces = std::map<unsigned int, PiecePolynomial<dim>>;

    UnknownNumbers() = default;

    /**
     * Collective.
     * @param own copies that are unknowns of this rank
     * @param small_pieces of all ranks; their first unknowns are set
     */
    UnknownNumbers(const SplineCopies<dim>         &copies,
                   const std::vector<unsigned int> &own,
                   SmallPieces                     &small_pieces,
                   const BackgroundGrid<dim>       &grid);

    /** Asks the owners of these copies for their numbers. Collective. */
    void
    ask(const std::vector<unsigned int> &of_others,
        const SplineCopies<dim>         &copies,
        const BackgroundGrid<dim>       &grid);

    /** Whether the number of a copy is known: it is an unknown. */
    bool
    has(const unsigned int copy) const
    {
      return numbers[copy] != dealii::numbers::invalid_unsigned_int;
    }

    /** Number of a copy's unknown. */
    unsigned int
    operator[](const unsigned int copy) const
    {
      return numbers[copy];
    }

    /** The number of unknowns of all ranks. */
    unsigned int
    n() const
    {
      return owned_.size();
    }

    /** The unknowns of this rank. */
    const IndexSet &
    owned() const
    {
      return owned_;
    }

    /** The piece of each of this rank's unknowns, in order. */
    const std::vector<unsigned int> &
    pieces() const
    {
      return pieces_;
    }

  private:
    std::vector<unsigned int> numbers; // by copy
    std::vector<unsigned int> pieces_;
    IndexSet                  owned_;
  };

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
                    const std::vector<GridCellClass> &classes)
      : occupancy(occupancy)
      , nodes(occupancy.nodes())
      , classes(classes)
      , reached(nodes.size(), 0)
    {}

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
