// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

/** The quadratic B-spline centred at 0 on a grid of spacing 1. */
double
spline(const double r)
{
  const double s = std::abs(r);
  return s < 0.5 ? 0.75 - s * s : s < 1.5 ? 0.5 * (1.5 - s) * (1.5 - s) : 0.;
}

double
slope(const double r)
{
  const double s = std::abs(r);
  return s < 0.5 ? -2. * r : s < 1.5 ? (r < 0. ? 1. : -1.) * (1.5 - s) : 0.;
}

template <int dim>
Point<dim>
random_position(std::mt19937 &generator)
{
  Point<dim> xi;
  for (unsigned int d = 0; d < dim; ++d)
    xi[d] = std::uniform_real_distribution<double>(0., 1.)(generator);
  return xi;
}


TEST_2D_3D(BSpline, ValuesAndGradientsFollowTheFormula)
{
  const double h = 7.;
  std::mt19937 generator(1);
  for (unsigned int trial = 0; trial < 50; ++trial)
    {
      const Point<dim>        xi = random_position<dim>(generator);
      const SplineValues<dim> splines(xi, h);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          // Position relative to the spline's centre.
          double r[dim], value = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            {
              r[d] = xi[d] - 0.5 - BSpline<dim>::offset(a, d);
              value *= spline(r[d]);
            }
          EXPECT_NEAR(splines.value[a], value, 1e-15);
          for (unsigned int d = 0; d < dim; ++d)
            {
              double gradient = slope(r[d]) / h;
              for (unsigned int e = 0; e < dim; ++e)
                if (e != d)
                  gradient *= spline(r[e]);
              EXPECT_NEAR(splines.gradient[d][a], gradient, 1e-15);
            }
        }
    }
}


TEST_2D_3D(BSpline, GradientsAreDerivatives)
{
  const double h = 50., eps = 1e-5;
  std::mt19937 generator(3);
  for (unsigned int trial = 0; trial < 20; ++trial)
    {
      const Point<dim>        xi = random_position<dim>(generator);
      const SplineValues<dim> splines(xi, h);
      for (unsigned int d = 0; d < dim; ++d)
        {
          Point<dim> before = xi, after = xi;
          before[d] -= eps;
          after[d] += eps;
          const SplineValues<dim> lower(before, h), upper(after, h);
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            EXPECT_NEAR((upper.value[a] - lower.value[a]) / (2. * eps * h),
                        splines.gradient[d][a],
                        1e-11);
        }
    }
}


TEST(BSpline, NumbersRunXFastest)
{
  EXPECT_EQ(BSpline<2>::n, 9u);
  EXPECT_EQ(BSpline<3>::n, 27u);
  unsigned int a = 0;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i, ++a)
        {
          EXPECT_EQ(BSpline<3>::offset(a, 0), i);
          EXPECT_EQ(BSpline<3>::offset(a, 1), j);
          EXPECT_EQ(BSpline<3>::offset(a, 2), k);
        }
}
