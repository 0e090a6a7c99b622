// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

constexpr double h = 20.; // µm

/** A place in the grid cell, another one for each number. */
template <int dim>
Point<dim>
some_place(const unsigned int p)
{
  Point<dim> xi;
  for (unsigned int d = 0; d < dim; ++d)
    xi[d] = 0.5 + 0.49 * std::sin(3. * p + d);
  return xi;
}

constexpr unsigned int n_places = 7;

double
diffusion(const unsigned int p)
{
  return 300. * (1. + p);
}

double
rate(const unsigned int p)
{
  return 2. + std::cos(p);
}

/** The sums entry by entry, as they are defined. */
template <int dim>
std::vector<double>
entry_by_entry(const bool lumped)
{
  constexpr unsigned int n = BSpline<dim>::n;
  std::vector<double>    matrix(n * n);
  for (unsigned int p = 0; p < n_places; ++p)
    {
      const SplineValues<dim> splines(some_place<dim>(p), h);
      for (unsigned int a = 0; a < n; ++a)
        {
          for (unsigned int b = 0; b < n; ++b)
            {
              for (unsigned int d = 0; d < dim; ++d)
                matrix[a * n + b] += diffusion(p) * splines.gradient[d][a] *
                                     splines.gradient[d][b];
              if (!lumped)
                matrix[a * n + b] +=
                  rate(p) * splines.value[a] * splines.value[b];
            }
          if (lumped)
            matrix[a * n + a] += rate(p) * splines.value[a];
        }
    }
  return matrix;
}


TEST_2D_3D(SplineMoments, GiveTheMatrix)
{
  for (const bool lumped : {false, true})
    {
      MatrixMoments<dim> moments;
      for (unsigned int p = 0; p < n_places; ++p)
        moments.add(some_place<dim>(p), {{diffusion(p), rate(p)}});
      const std::vector<double> exact = entry_by_entry<dim>(lumped);
      std::vector<double>       matrix(exact.size());
      add_matrix(moments, h, lumped, matrix);
      double largest = 0.;
      for (unsigned int k = 0; k < exact.size(); ++k)
        {
          largest = std::max(largest, std::abs(exact[k]));
          EXPECT_NEAR(matrix[k], exact[k], 1e-14);
        }
      EXPECT_GT(largest, 0.1);
    }
}


TEST_2D_3D(SplineMoments, GiveTheLoad)
{
  constexpr unsigned int n = BSpline<dim>::n;
  LoadMoments<dim>       moments;
  std::array<double, n>  exact{};
  for (unsigned int p = 0; p < n_places; ++p)
    {
      const SplineValues<dim> splines(some_place<dim>(p), h);
      moments.add(some_place<dim>(p), {{rate(p)}});
      for (unsigned int a = 0; a < n; ++a)
        exact[a] += rate(p) * splines.value[a];
    }
  const auto sums = spline_sums(moments);
  for (unsigned int a = 0; a < n; ++a)
    EXPECT_NEAR(sums[a], exact[a], 1e-14);
}
