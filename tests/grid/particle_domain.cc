// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/particle_domain.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../body_on_grid.h"

using namespace Morula;

namespace
{
  template <int dim>
  void
  check_points()
  {
    const double side = 30.;
    Point<dim>   x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = 7. - 20. * d;
    const ParticleDomain<dim> domain(x, std::pow(side, dim));
    EXPECT_NEAR((domain.upper() - domain.lower()).norm(),
                side * std::sqrt(1. * dim),
                1e-12);
    for (const unsigned int n : {1u, 2u, 3u})
      {
        std::vector<Point<dim>> points;
        domain.for_quadrature_points(n, [&](const Point<dim> &point) {
          points.push_back(point);
        });
        ASSERT_EQ(points.size(), std::pow(n, dim));

        // Their cells tile the box: the mean is its centre, the second moment
        // that of n midpoints.
        const double   n_points = points.size();
        Tensor<1, dim> mean;
        Tensor<2, dim> second;
        for (const Point<dim> &point : points)
          {
            mean += (point - x) / n_points;
            second += outer_product(point - x, point - x) / n_points;
            for (unsigned int d = 0; d < dim; ++d)
              {
                EXPECT_GT(point[d], domain.lower()[d]);
                EXPECT_LT(point[d], domain.upper()[d]);
              }
          }
        EXPECT_LE(mean.norm(), 1e-13);
        const double moment = side * side / 12. * (1. - 1. / (n * n));
        EXPECT_LE((second - moment * unit_tensor<dim>()).norm(), 1e-11);
      }
  }

  /** Two points per grid spacing at least, and no more than needed. */
  template <int dim>
  void
  check_number()
  {
    const double h      = 50.;
    const auto n_points = [&](const double side, const unsigned int least = 1) {
      return ParticleDomain<dim>(Point<dim>(), std::pow(side, dim))
        .n_per_direction(h, least);
    };
    EXPECT_EQ(n_points(1.), 1u);
    EXPECT_EQ(n_points(25.), 1u);
    EXPECT_EQ(n_points(25.1), 2u);
    EXPECT_EQ(n_points(50.), 2u);
    EXPECT_EQ(n_points(120.), 5u);
    EXPECT_EQ(n_points(1., 2), 2u);
    EXPECT_EQ(n_points(120., 2), 5u);
  }
} // namespace


TEST(ParticleDomain, PointsTileTheBox){MORULA_BOTH_DIMENSIONS(check_points)}


TEST(ParticleDomain, HasTwoPointsPerGridSpacing)
{
  MORULA_BOTH_DIMENSIONS(check_number)
}
