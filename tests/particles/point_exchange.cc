// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

/** Distance of a point from a grid cell; 0 inside. */
template <int dim>
double
distance(const Point<dim> &x, const Point<dim> &corner, const double h)
{
  double square = 0.;
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double gap = std::max({0., corner[d] - x[d], x[d] - corner[d] - h});
      square += gap * gap;
    }
  return std::sqrt(square);
}


TEST_2D_3D(PointExchange, SendsEveryPointToItsOwner)
{
  // The larger number is more than a rank sends at once.
  for (const unsigned int n : {1000, 300000})
    {
      if (dim == 3 && n > 1000)
        continue;
      const auto          all = random_points<dim>(n, 230., 3, 1);
      BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
      enclose(grid, all);
      expect_same_points(send_to_owners(dealt(all), grid), owned(all, grid));

      // No rank has any; one rank has all.
      EXPECT_EQ(send_to_owners(PointList<dim>(3), grid).size(), 0u);
      const auto one =
        selected(all, [](const std::size_t) { return this_rank() == 0; });
      expect_same_points(send_to_owners(one, grid), owned(all, grid));
    }
}


TEST_2D_3D(PointExchange, HaloHoldsAllPointsWithinReach)
{
  const auto          all = random_points<dim>(600, 180., 2, 2);
  BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
  enclose(grid, all);
  const GridBox<dim>                   &box  = grid.box();
  const auto                            mine = owned(all, grid);
  const std::set<types::particle_index> own(mine.ids.begin(), mine.ids.end());
  for (const double reach : {5., 50., 60., 130.})
    {
      const auto                            others = halo(mine, grid, reach);
      const std::set<types::particle_index> found(others.ids.begin(),
                                                  others.ids.end());
      EXPECT_EQ(found.size(), others.size()); // each once
      for (std::size_t i = 0; i < all.size(); ++i)
        {
          if (own.count(all.ids[i]) > 0)
            {
              EXPECT_EQ(found.count(all.ids[i]), 0u);
              continue;
            }
          bool near = false;
          for (unsigned int n = 0; n < box.size(); ++n)
            near = near || (grid.owner(n) == this_rank() &&
                            distance(all.positions[i],
                                     box.corner(box.index(n)),
                                     box.spacing()) <= reach);
          if (near)
            {
              EXPECT_EQ(found.count(all.ids[i]), 1u);
            }
        }
      expect_same_points(others, selected(all, [&](const std::size_t i) {
                           return found.count(all.ids[i]) > 0;
                         }));
    }
}
