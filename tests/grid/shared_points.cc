// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

constexpr double h = 30.;

const GridBox<2> box({{{-3, -3}}}, {{{6, 6}}}, h, Point<2>(0.1, -7.));

/** The grid cells that share a point; also checks that it hardly moves. */
std::set<std::array<int, 2>>
grid_cells(const Point<2> &x)
{
  std::set<std::array<int, 2>> found;
  const SharedPoint<2>         point(box, x);
  point.for_each([&](const Point<2> &position) {
    EXPECT_LT(position.distance(x), 1e-5 * h);
    found.insert(box.locate(position));
  });
  EXPECT_EQ(found.size(), point.n_shares());
  return found;
}

using Cells = std::set<std::array<int, 2>>;


TEST(SharedPoint, InsideBelongsToOneGridCellAndStays)
{
  const Point<2>       x(0.1 + 0.3 * h, -7. + 1.9 * h);
  const SharedPoint<2> point(box, x);
  EXPECT_EQ(point.n_shares(), 1u);
  point.for_each([&](const Point<2> &position) { EXPECT_EQ(position, x); });
  EXPECT_EQ(grid_cells(x), (Cells{{{0, 1}}}));
}


// Also where rounding puts it beside the line, on either side.
TEST(SharedPoint, OnALineBelongsToBothSides)
{
  for (const double off : {-1e-9, 0., 1e-9})
    EXPECT_EQ(grid_cells(Point<2>(0.1 + h * (2. + off), -7. - 0.5 * h)),
              (Cells{{{1, -1}}, {{2, -1}}}))
      << off;
}


TEST(SharedPoint, OnACornerBelongsToAllAround)
{
  EXPECT_EQ(grid_cells(Point<2>(0.1 - h, -7.)),
            (Cells{{{-2, -1}}, {{-1, -1}}, {{-2, 0}}, {{-1, 0}}}));
}
