// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/obstacles/body.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "common/complaint.h"
#include "common/polygons.h"
#include "common/temporary_file.h"

using namespace Morula;

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
      const Distance<3> expected = exact->distance(x);
      const Distance<3> found    = mesh->distance(x);
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
      const Distance<3> at = mesh->distance(Point<3>(15., y, 0.));
      EXPECT_NEAR(at.value, 0., 1e-12);
      EXPECT_LT((at.gradient - Tensor<1, 3>({1., 0., 0.})).norm(), 1e-12);
      EXPECT_EQ(at.curvature.norm(), 0.);
    }
}


TEST(MeshBody, ManyTrianglesAreASphere)
{
  const double        R        = 40.;
  const Polygons      polygons = sphere(R, 5);
  const TemporaryFile file(".off", polygons.off());
  double              sagitta = 0., longest = 0.;
  for (const auto &face : polygons.faces)
    {
      Tensor<1, 3> sum;
      for (unsigned int k = 0; k < 3; ++k)
        {
          const Point<3> &p = polygons.points[face[k]];
          sum += p;
          longest =
            std::max(longest, p.distance(polygons.points[face[(k + 1) % 3]]));
        }
      sagitta = std::max(sagitta, R - sum.norm() / 3.);
    }
  ASSERT_LT(longest, 0.1 * R);
  ObstacleKeys ball("ball");
  ball.shape         = "sphere";
  ball.radius        = R;
  const auto   exact = make_body<3>(ball);
  const auto   mesh  = make_body<3>(mesh_at(file.path, {0., 0., 0.}));
  std::mt19937 generator(2);
  for (unsigned int i = 0; i < 1000; ++i)
    {
      const Point<3>    x        = random_place(generator, 60.);
      const Distance<3> expected = exact->distance(x);
      if (expected.value < -10.)
        continue;
      const Distance<3> found = mesh->distance(x);
      EXPECT_NEAR(found.value, expected.value, sagitta);
      EXPECT_LT((found.gradient - expected.gradient).norm(), longest / R);
    }
}


TEST(MeshBody, IsRefusedWhereItHasNoInside)
{
  const auto complaint = [](const std::string &text) {
    const TemporaryFile file(".off", text);
    return complaint_of(
      [&] { make_body<3>(mesh_at(file.path, {0., 0., 0.})); });
  };
  Polygons open = brick();
  open.faces.pop_back();
  expect_parts(complaint(open.off()),
               {"Obstacles/wall/Surface mesh", "The surface is open"});
  Polygons two   = brick();
  Polygons other = brick();
  for (Point<3> &p : other.points)
    p += Tensor<1, 3>({5., 6., 7.});
  two.append(other);
  expect_parts(complaint(two.off()), {"intersects or touches itself"});
  expect_parts(complaint_of([] {
                 make_body<3>(mesh_at("no/such/file.stl", {0., 0., 0.}));
               }),
               {"check that it exists"});
  expect_parts(complaint_of([] { make_body<3>(mesh_at("", {0., 0., 0.})); }),
               {"a file, as Shape = mesh"});
  expect_parts(complaint_of([] { make_body<2>(mesh_at("a.off", {0., 0.})); }),
               {"box in 2-D"});
}
