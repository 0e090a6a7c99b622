// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  template <int dim>
  WallPoint<dim>
  wall(const Point<dim> &position, const unsigned int direction, const int sign)
  {
    WallPoint<dim> point;
    point.position          = position;
    point.normal[direction] = sign;
    point.spacing           = 1.;
    return point;
  }
} // namespace


// A floor at z = 0 under a lattice that starts at z = 0.5.
TEST(DirichletWalls, BoundBothDaughters)
{
  std::vector<Point<3>> points = lattice<3>(4);
  for (Point<3> &p : points)
    p += Point<3>(0.5, 0.5, 0.5);
  DividingTissue<3> tissue(points);
  for (unsigned int i = 0; i < 4; ++i)
    for (unsigned int j = 0; j < 4; ++j)
      tissue.walls.push_back(wall(Point<3>(i + 0.5, j + 0.5, 0.), 2, -1));
  tissue.divide(5, Tensor<1, 3>({0., 0., 1.}), 1.);
  tissue.divide(5, Tensor<1, 3>({0., 0.6, -0.8}), 1.);

  // Without its neighbours the same walls stand, up to one length.
  const auto inside = tissue.distances();
  EXPECT_EQ(inside[0], (Distances{{0.25, 0.25}}));
  EXPECT_NEAR(inside[1][0], 0.5 * 0.5 / 0.8, 1e-15);
  EXPECT_NEAR(inside[1][1], 0.5 * 0.5 / 0.8, 1e-15);

  DividingTissue<3> lone({points[5]});
  lone.walls = tissue.walls;
  for (const double height : {0.3, 0.99, 1.01})
    {
      lone.positions[0][2] = height;
      lone.dividing.clear();
      lone.divide(0, Tensor<1, 3>({0., 0., 1.}), 1.);
      const double expected = height < 1. ? height / 2. : 0.25;
      EXPECT_EQ(lone.distances()[0], (Distances{{expected, expected}}));
    }
}


// The nearer of neighbour and boundary counts, on each side.
TEST(DirichletWalls, NearestWallCounts)
{
  for (const double x : {0.2, 0.6})
    {
      DividingTissue<2> tissue({Point<2>(), Point<2>(0.8, 0.)});
      tissue.walls.push_back(wall(Point<2>(x, 0.1), 0, 1));
      tissue.divide(0, Tensor<1, 2>({1., 0.}), 1.);
      const double expected = 0.5 * std::min(x, 0.4);
      for (const unsigned int side : {0, 1})
        EXPECT_DOUBLE_EQ(tissue.distances()[0][side], expected);
    }
}


// A half-space reaches one spacing from its point.
TEST(DirichletWalls, AreLocal)
{
  for (const double offset : {0.99, 1.01, -0.99, -1.01})
    {
      DividingTissue<2> tissue({Point<2>()});
      tissue.walls.push_back(wall(Point<2>(0.3, offset), 0, 1));
      tissue.divide(0, Tensor<1, 2>({-1., 0.}), 1.);
      const double expected = std::abs(offset) < 1. ? 0.15 : 0.25;
      EXPECT_EQ(tissue.distances()[0], (Distances{{expected, expected}}));
    }
}


// A cell on a wall, or a little beyond: its daughters stay apart, and neither
// goes farther than half of 1e-3 lengths.
TEST(DirichletWalls, CellsOnAWall)
{
  for (const double depth : {1e-5, 0., -1e-5, -0.05})
    {
      DividingTissue<2> tissue({Point<2>(0., depth), Point<2>(0., depth + 1.)});
      tissue.walls.push_back(wall(Point<2>(0.2, 0.), 1, -1));
      tissue.divide(0, Tensor<1, 2>({0., 1.}), 1.);
      const Distances d = tissue.distances()[0];
      EXPECT_NEAR(d[0], 5e-4, 1e-18);
      EXPECT_EQ(d[1], 0.25);
    }

  // Far beyond, the boundary is that of another part of the body.
  DividingTissue<2> tissue({Point<2>(0., -0.2), Point<2>(0., 0.8)});
  tissue.walls.push_back(wall(Point<2>(0.2, 0.), 1, -1));
  tissue.divide(0, Tensor<1, 2>({0., 1.}), 1.);
  EXPECT_EQ(tissue.distances()[0], (Distances{{0.25, 0.25}}));
}


// Cells too far from each other for Voronoi walls: the nearest of all
// half-spaces, tried one by one.
TEST(DirichletWalls, Many)
{
  std::mt19937          generator(13);
  std::vector<Point<3>> points = lattice<3>(6);
  for (Point<3> &p : points)
    p *= 3.;
  DividingTissue<3> tissue(points);
  for (unsigned int i = 0; i < points.size(); ++i)
    tissue.divide(i, random_axis<3>(generator), 1.4);
  for (unsigned int i = 0; i < 3000; ++i)
    {
      WallPoint<3> point;
      point.position = random_point<3>(generator, 15.);
      point.normal   = random_axis<3>(generator);
      point.spacing  = 0.1 + 1.4 * i / 3000.;
      tissue.walls.push_back(point);
    }

  const auto                  result = tissue.distances();
  std::array<unsigned int, 3> n_walls{{0, 0, 0}};
  for (unsigned int i = 0; i < points.size(); ++i)
    {
      Distances nearest{{infinity, infinity}};
      for (const WallPoint<3> &point : tissue.walls)
        for (const unsigned int side : {0, 1})
          {
            const Tensor<1, 3> ray =
              (side == 0 ? -1. : 1.) * tissue.dividing[i].axis;
            const double depth = (point.position - points[i]) * point.normal;
            const double slope = ray * point.normal;
            const double s     = std::max(depth, 1.4e-3) / slope;
            if (slope > 0. && depth >= -0.14 && s <= 1.4 &&
                (points[i] + s * ray).distance(point.position) <= point.spacing)
              nearest[side] = std::min(nearest[side], s);
          }

      const double nearer = std::min(nearest[0], nearest[1]);
      ++n_walls[std::isfinite(nearest[0]) + std::isfinite(nearest[1])];
      for (const unsigned int side : {0, 1})
        EXPECT_NEAR(result[i][side],
                    std::isfinite(nearest[side]) ? nearest[side] / 2. :
                    std::isfinite(nearer)        ? nearer / 2. :
                                                   0.35,
                    1e-14);
    }
  for (const unsigned int n : n_walls)
    EXPECT_GT(n, 10u);
}
