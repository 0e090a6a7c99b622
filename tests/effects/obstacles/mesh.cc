// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  ObstacleKeys
  mesh_at(const std::string &file, const std::vector<double> &center)
  {
    ObstacleKeys keys("wall");
    keys.shape        = "mesh";
    keys.surface_mesh = file;
    keys.center       = center;
    return keys;
  }

  /** A box of the edges 30, 20, 24 about the origin. */
  Polygons
  brick()
  {
    Polygons result = cube(Point<3>(-0.5, -0.5, -0.5), 1.);
    for (Point<3> &p : result.points)
      p = Point<3>(30. * p[0], 20. * p[1], 24. * p[2]);
    return result;
  }

  Point<3>
  random_place(std::mt19937 &generator, const double half)
  {
    std::uniform_real_distribution<double> uniform(-half, half);
    return {uniform(generator), uniform(generator), uniform(generator)};
  }
} // namespace


TEST(MeshBody, ABrickIsTheBox)
{
  const TemporaryFile file(".off", brick().off());
  ObstacleKeys        box("box");
  box.shape              = "box";
  box.size               = {30., 20., 24.};
  box.center             = {3., 4., 5.};
  const auto   exact     = make_body<3>(box);
  const auto   mesh      = make_body<3>(mesh_at(file.path, {3., 4., 5.}));
  unsigned int n_inside  = 0;
  unsigned int n_at_edge = 0;
  std::mt19937 generator(1);
  for (unsigned int i = 0; i < 2000; ++i)
    {
      const Point<3>    x = Point<3>(3., 4., 5.) + random_place(generator, 25.);
      const Distance<3> expected = exact(x);
      const Distance<3> found    = mesh(x);
      EXPECT_NEAR(found.value, expected.value, 1e-9);
      EXPECT_LT((found.gradient - expected.gradient).norm(), 1e-9);
      EXPECT_LT((found.curvature - expected.curvature).norm(), 1e-9);
      n_inside += expected.value < 0.;
      n_at_edge += expected.curvature.norm() > 0.;
    }
  EXPECT_GT(n_inside, 100u);
  EXPECT_GT(n_at_edge, 500u);
}


TEST(MeshBody, ItsSurfaceHasANormal)
{
  const TemporaryFile file(".off", brick().off());
  const auto          mesh = make_body<3>(mesh_at(file.path, {0., 0., 0.}));
  for (const double y : {-3., 0., 7.})
    {
      // 0: on the edge between the two triangles of the face
      const Distance<3> at = mesh(Point<3>(15., y, 0.));
      EXPECT_NEAR(at.value, 0., 1e-12);
      EXPECT_LT((at.gradient - Tensor<1, 3>({1., 0., 0.})).norm(), 1e-12);
      EXPECT_EQ(at.curvature.norm(), 0.);
    }
}
