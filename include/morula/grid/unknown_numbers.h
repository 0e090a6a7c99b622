// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_unknown_numbers_h
#define morula_grid_unknown_numbers_h

#include <morula/grid/background_grid.h>
#include <morula/grid/occupancy.h>
#include <morula/grid/spline_copies.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/numbers.h>

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
    has(const unsigned int copy) const;

    /** Number of a copy's unknown. */
    unsigned int
    operator[](const unsigned int copy) const;

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
    /** Numbers the small pieces' unknowns behind @p next, which are this
     *  rank's. Collective. */
    void
    add_small_pieces(const SplineCopies<dim>   &copies,
                     SmallPieces               &small_pieces,
                     const BackgroundGrid<dim> &grid,
                     unsigned int               next);

    std::vector<unsigned int> numbers; // by copy
    std::vector<unsigned int> pieces_;
    IndexSet                  owned_;
  };
} // namespace Morula

#endif
