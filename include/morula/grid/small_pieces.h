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
   * The polynomial that the splines of a small piece follow from: Σ c_m m(ξ)
   * over the monomials m of ξ = (x - center)/h up to a degree, with one unknown
   * for each: doc/theory.md (3.4).
   */
  template <int dim>
  struct PiecePolynomial
  {
    Point<dim>   center; // µm
    bool         quadratic;
    unsigned int first_unknown = numbers::invalid_unsigned_int;

    unsigned int
    n_unknowns() const;

    /** Unknowns and weights of the spline centred at @p x (µm), where the grid
     *  spacing is @p h (µm). */
    std::vector<std::pair<unsigned int, double>>
    expression(const Point<dim> &x, const double h) const;
  };

  /**
   * The pieces that have a polynomial: quadratic if the piece is smaller than a
   * grid cell; affine if it is smaller than two and has fewer than 3^dim
   * particles, or has no inner grid cell. By piece, without numbers of
   * unknowns.
   */
  template <int dim>
  std::map<unsigned int, PiecePolynomial<dim>>
  find_small_pieces(const Occupancy<dim>             &occupancy,
                    const std::vector<GridCellClass> &classes,
                    const SplineCopies<dim>          &copies);
} // namespace Morula

#endif
