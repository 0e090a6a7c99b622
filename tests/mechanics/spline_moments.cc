// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/spline_moments.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace Morula;

namespace
{
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

  template <int dim>
  void
  check_matrix(const bool lumped)
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

  template <int dim>
  void
  check_mass_matrix()
  {
    constexpr unsigned int n = BSpline<dim>::n;
    MassMoments<dim>       moments;
    std::vector<double>    exact(n * n);
    for (unsigned int p = 0; p < n_places; ++p)
      {
        const SplineValues<dim> splines(some_place<dim>(p), h);
        moments.add(some_place<dim>(p), {{rate(p)}});
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            exact[a * n + b] += rate(p) * splines.value[a] * splines.value[b];
      }
    const std::vector<double> matrix = mass_matrix(moments);
    for (unsigned int k = 0; k < exact.size(); ++k)
      EXPECT_NEAR(matrix[k], exact[k], 1e-14);
  }

  template <int dim>
  void
  check_sums()
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

  template <int dim>
  void
  check_value()
  {
    LocalField<dim, 1> field;
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      field.coefficient[0][a] = std::sin(1. + a);
    for (unsigned int p = 0; p < n_places; ++p)
      {
        const Point<dim> xi = some_place<dim>(p);
        EXPECT_NEAR(value_at(field, xi),
                    field.value(SplineValues<dim>(xi, h))[0],
                    1e-15);
      }
  }
} // namespace


TEST(SplineMoments, GiveTheMatrix)
{
  for (const bool lumped : {false, true})
    {
      check_matrix<2>(lumped);
      check_matrix<3>(lumped);
    }
}


TEST(SplineMoments, GiveTheMassMatrix)
{
  check_mass_matrix<2>();
  check_mass_matrix<3>();
}


TEST(SplineMoments, GiveTheLoad)
{
  check_sums<2>();
  check_sums<3>();
}


TEST(SplineMoments, ValuesAreThoseOfTheField)
{
  check_value<2>();
  check_value<3>();
}
