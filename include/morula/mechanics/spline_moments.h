// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_spline_moments_h
#define morula_mechanics_spline_moments_h

#include <morula/mechanics/term.h>

#include <array>
#include <vector>

namespace Morula
{
  /**
   * Sums over weighted points of a grid cell, doc/theory.md (11.6), with powers
   * up to the degree, for several weights at once; the last direction's power
   * runs fastest. Sums of splines (degree 2) and of products of two splines
   * (degree 4) are combinations of these.
   */
  template <int dim, unsigned int degree, unsigned int n_weights>
  struct SplineMoments
  {
    static constexpr unsigned int n_powers = degree + 1;
    static constexpr unsigned int n_of_first =
      Utilities::pow(n_powers, dim - 1);
    static constexpr unsigned int n = n_powers * n_of_first;

    /** The sums of all powers, by weight. */
    std::array<std::array<double, n>, n_weights> sums{};

    /** Adds a point at @p xi. */
    void
    add(const Point<dim> &xi, const std::array<double, n_weights> &weights)
    {
      std::array<std::array<double, n_powers>, dim> powers;
      for (unsigned int d = 0; d < dim; ++d)
        {
          powers[d][0] = 1.;
          for (unsigned int i = 0; i < degree; ++i)
            powers[d][i + 1] = powers[d][i] * (xi[d] - 0.5);
        }
      std::array<double, n_of_first> others; // all directions but the first
      if constexpr (dim == 2)
        others = powers[1];
      else
        for (unsigned int i = 0; i < n_powers; ++i)
          for (unsigned int j = 0; j < n_powers; ++j)
            others[i * n_powers + j] = powers[1][i] * powers[2][j];
      for (unsigned int w = 0; w < n_weights; ++w)
        for (unsigned int i = 0; i < n_powers; ++i)
          {
            const double  factor = weights[w] * powers[0][i];
            double *const row    = &sums[w][i * n_of_first];
            for (unsigned int q = 0; q < n_of_first; ++q)
              row[q] += factor * others[q];
          }
    }
  };

  /** Moments of points with the weights D V and k V, in this order: these sums
   *  give the matrix of a field. */
  template <int dim>
  using MatrixMoments = SplineMoments<dim, 4, 2>;

  /** Moments of points with one weight, for products of two splines. */
  template <int dim>
  using MassMoments = SplineMoments<dim, 4, 1>;

  /** Moments of points with one weight, for single splines. */
  template <int dim>
  using LoadMoments = SplineMoments<dim, 2, 1>;

  /**
   * Adds Σ_p (D V)_p ∇N_a·∇N_b + (k V)_p N_a N_b to the 3^dim x 3^dim numbers
   * of @p matrix, row by row.
   * @param h grid spacing, µm
   * @param lumped whether Σ_p (k V)_p N_a stands on the diagonal instead
   */
  template <int dim>
  void
  add_matrix(const MatrixMoments<dim> &moments,
             const double              h,
             const bool                lumped,
             std::vector<double>      &matrix);

  /** Σ_p w_p N_a N_b, row by row. */
  template <int dim>
  std::vector<double>
  mass_matrix(const MassMoments<dim> &moments);

  /** Σ_p w_p N_a of all splines. */
  template <int dim>
  std::array<double, BSpline<dim>::n>
  spline_sums(const LoadMoments<dim> &moments);

  /** The field at @p xi, one direction after the other. */
  template <int dim>
  double
  value_at(const LocalField<dim, 1> &field, const Point<dim> &xi);
} // namespace Morula

#endif
