// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"


// Found are those within the radius and no others, each once, also around
// places outside of the box.
TEST_2D_3D(PointBins, VisitsThePointsWithinTheRadius)
{
  GridIndex<dim> first, n;
  Point<dim>     offset;
  for (unsigned int d = 0; d < dim; ++d)
    {
      first[d]  = -3 + int(d);
      n[d]      = 4 + int(d);
      offset[d] = 0.7 * d;
    }
  const GridBox<dim> box(first, n, 2.5, offset);

  std::mt19937                           generator(3);
  std::uniform_real_distribution<double> fraction(0., 1. - 1e-12);
  std::vector<Point<dim>>                positions(300);
  for (Point<dim> &x : positions)
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = box.corner(first)[d] + 2.5 * n[d] * fraction(generator);

  for (const double radius : {0., 0.4, 2.5, 7., 100.})
    for (unsigned int i = 0; i < positions.size(); i += 7)
      for (const double factor : {1., 3.})
        {
          const Point<dim>          center(factor * positions[i]);
          std::vector<unsigned int> visits(positions.size(), 0);
          PointBins<dim>(box, positions)
            .visit_within(center, radius, [&](const unsigned int p) {
              ++visits[p];
            });
          for (unsigned int p = 0; p < positions.size(); ++p)
            EXPECT_EQ(visits[p],
                      positions[p].distance(center) <= radius ? 1u : 0u);
        }
}
