// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"


TEST_2D_3D(ParticleDomain, PointsTileTheBox)
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
      std::vector<Point<dim>>               points;
      typename ParticleDomain<dim>::Numbers numbers;
      numbers.fill(n);
      domain.for_quadrature_points(numbers, [&](const Point<dim> &point) {
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


// The affine image of a cube: points, second moments, length, bounds.
TEST_2D_3D(ParticleDomain, DeformsWithItsCell)
{
  const double   V0 = std::pow(12., dim);
  Tensor<2, dim> F  = unit_tensor<dim>();
  F[0][0]           = 2.;
  F[0][1]           = 0.7;
  F[dim - 1][0]     = -0.4;
  Point<dim> x;
  x[0]                        = 5.;
  const Tensor<2, dim>      A = 12. * F;
  const ParticleDomain<dim> cube(Point<dim>(), V0), box(x, A);
  EXPECT_NEAR(box.volume(), V0 * determinant(F), 1e-9 * V0);

  typename ParticleDomain<dim>::Numbers n;
  for (unsigned int k = 0; k < dim; ++k)
    n[k] = 2 + k;
  std::vector<Point<dim>> points, of_cube;
  box.for_quadrature_points(n, [&](const Point<dim> &point) {
    points.push_back(point);
  });
  cube.for_quadrature_points(n, [&](const Point<dim> &point) {
    of_cube.push_back(point);
  });
  ASSERT_EQ(points.size(), of_cube.size());
  for (std::size_t q = 0; q < points.size(); ++q)
    EXPECT_LE((points[q] - x - F * (of_cube[q] - Point<dim>())).norm(), 1e-12);

  // The cube of the same volume, and the box around both.
  EXPECT_NEAR(box.upper()[0] - box.lower()[0],
              std::pow(box.volume(), 1. / dim),
              1e-12);
  Point<dim> least = box.lower(), greatest = box.upper();
  for (unsigned int i = 0; i < 1u << dim; ++i)
    {
      Point<dim> corner = x;
      for (unsigned int k = 0; k < dim; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          corner[d] += ((i >> k & 1) - 0.5) * A[d][k];
      for (unsigned int d = 0; d < dim; ++d)
        {
          least[d]    = std::min(least[d], corner[d]);
          greatest[d] = std::max(greatest[d], corner[d]);
        }
    }
  EXPECT_LE(box.bounds().first.distance(least), 1e-12);
  EXPECT_LE(box.bounds().second.distance(greatest), 1e-12);

  // As long as the longest image of a unit vector.
  double longest = 0.;
  for (unsigned int i = 0; i < 100000; ++i)
    {
      Tensor<1, dim> e;
      const double   a = 0.01 * i;
      e[0]             = std::cos(a);
      e[1]             = std::sin(a);
      if (dim == 3)
        {
          const double b = 0.0137 * i;
          e *= std::cos(b);
          e[dim - 1] = std::sin(b);
        }
      longest = std::max(longest, (A * e).norm());
    }
  EXPECT_NEAR(box.length(), longest, 1e-3 * longest);
  EXPECT_DOUBLE_EQ(cube.length(), 12.);
}


// A point whose F has lost all measure does not reach across the grid.
TEST_2D_3D(ParticleDomain, EndsSomewhere)
{
  Tensor<2, dim> A = 10. * unit_tensor<dim>();
  A[0][0]          = 1e7;
  A[1][1]          = 1e-5;
  const ParticleDomain<dim> wild(Point<dim>(), A);
  EXPECT_NEAR(wild.volume() / std::pow(10., dim), 1., 1e-12);
  EXPECT_NEAR(wild.bounds().second[0], 80., 1e-9);
  EXPECT_EQ(wild.n_per_edge(40., 1)[0], 8u);
}


// Two points per grid spacing at least, and no more than needed.
TEST_2D_3D(ParticleDomain, HasTwoPointsPerGridSpacing)
{
  const double h        = 50.;
  const auto   n_points = [&](const double side, const unsigned int least = 1) {
    const auto n = ParticleDomain<dim>(Point<dim>(), std::pow(side, dim))
                     .n_per_edge(h, least);
    EXPECT_EQ(n.front(), n.back());
    return n.front();
  };
  EXPECT_EQ(n_points(1.), 1u);
  EXPECT_EQ(n_points(25.), 1u);
  EXPECT_EQ(n_points(25.1), 2u);
  EXPECT_EQ(n_points(50.), 2u);
  EXPECT_EQ(n_points(120.), 5u);
  EXPECT_EQ(n_points(1., 2), 2u);
  EXPECT_EQ(n_points(120., 2), 5u);

  // A stretched box has more along its long edge, turned or not.
  const auto     turn  = rotation<dim>(0.7);
  Tensor<2, dim> edges = 10. * unit_tensor<dim>();
  edges[0][0]          = 60.;
  for (const auto &A : {edges, turn * edges})
    {
      const auto n = ParticleDomain<dim>(Point<dim>(), A).n_per_edge(h, 1);
      EXPECT_EQ(n[0], 3u);
      for (unsigned int k = 1; k < dim; ++k)
        EXPECT_EQ(n[k], 1u);
    }
  // ... but none fewer than the cube of its volume.
  edges        = 30. * unit_tensor<dim>();
  edges[0][0]  = 10.;
  edges[1][1]  = 90.;
  const auto n = ParticleDomain<dim>(Point<dim>(), edges).n_per_edge(h, 1);
  EXPECT_EQ(n[0], 2u);
  EXPECT_EQ(n[1], 4u);
}
