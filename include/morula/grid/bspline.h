// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_bspline_h
#define morula_grid_bspline_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/utilities.h>

#include <array>

namespace Morula
{
  using namespace dealii;

  /**
   * The quadratic B-splines that do not vanish on one grid cell: 3^dim tensor
   * products, numbered x fastest. Spline a is centred on the neighbouring grid
   * cell with coordinates + offset(a). On ξ ∈ [0, 1] the one-dimensional
   * splines are ½(1-ξ)², ½+ξ-ξ², ½ξ²: doc/theory.md (2.3). The displacement is
   * their sum, u(x) = Σ_a u_a N_a(x): equation (5) of the paper.
   */
  template <int dim>
  struct BSpline
  {
    /** Number of splines on a grid cell. */
    static constexpr unsigned int n = Utilities::pow(3, dim);

    /** Coordinate of spline @p a's grid cell minus that of the grid cell: -1, 0
     *  or 1. */
    static constexpr int
    offset(const unsigned int a, const unsigned int direction)
    {
      unsigned int digit = a;
      for (unsigned int d = 0; d < direction; ++d)
        digit /= 3;
      return static_cast<int>(digit % 3) - 1;
    }
  };

  /** Values and gradients (1/µm) of a grid cell's splines at one point. */
  template <int dim>
  struct SplineValues
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    double value[n];
    double gradient[dim][n];

    /**
     * @param xi position in the grid cell, each coordinate in [0, 1]
     * @param h  grid spacing, µm
     */
    SplineValues(const Point<dim> &xi, const double h)
    {
      double N[dim][3], dN[dim][3];
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double s = xi[d];
          N[d][0]        = 0.5 * (1. - s) * (1. - s);
          N[d][1]        = 0.5 + s - s * s;
          N[d][2]        = 0.5 * s * s;
          dN[d][0]       = (s - 1.) / h;
          dN[d][1]       = (1. - 2. * s) / h;
          dN[d][2]       = s / h;
        }
      if constexpr (dim == 2)
        for (unsigned int j = 0, a = 0; j < 3; ++j)
          for (unsigned int i = 0; i < 3; ++i, ++a)
            {
              value[a]       = N[0][i] * N[1][j];
              gradient[0][a] = dN[0][i] * N[1][j];
              gradient[1][a] = N[0][i] * dN[1][j];
            }
      else
        for (unsigned int k = 0, a = 0; k < 3; ++k)
          for (unsigned int j = 0; j < 3; ++j)
            for (unsigned int i = 0; i < 3; ++i, ++a)
              {
                value[a]       = N[0][i] * N[1][j] * N[2][k];
                gradient[0][a] = dN[0][i] * N[1][j] * N[2][k];
                gradient[1][a] = N[0][i] * dN[1][j] * N[2][k];
                gradient[2][a] = N[0][i] * N[1][j] * dN[2][k];
              }
    }
  };
} // namespace Morula

#endif
