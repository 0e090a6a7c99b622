// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_small_pieces_h
#define morula_grid_small_pieces_h

#include <morula/grid/occupancy.h>
#include <morula/grid/spline_copies.h>

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
} // namespace Morula

#endif
