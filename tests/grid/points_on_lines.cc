// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

constexpr double L = 0.5; // of the cells; h = 1

/** A ball of cells whose centres are @p off_line to the right of a grid line
 *  or of the middle between two. */
template <int dim>
Occupancy<dim>
ball_on_lines(const double off_line)
{
  GridIndex<dim> first, size;
  first.fill(-8);
  size.fill(16);
  Point<dim> half_a_cell;
  for (unsigned int d = 0; d < dim; ++d)
    half_a_cell[d] = 0.5 * L;

  std::vector<ParticleDomain<dim>> domains;
  for (Point<dim> x :
       lattice_points<dim>(half_a_cell, 4., L, [](const auto &x) {
         return x.norm() < 3.75;
       }))
    {
      x[0] += off_line;
      domains.emplace_back(x, std::pow(L, dim));
    }
  return occupancy_of(GridBox<dim>(first, size, 1., Point<dim>()), domains);
}


// Turned by 180° its grid cells are of the same classes.
TEST_2D_3D(PointsOnLines, CountOnBothSides)
{
  for (const double off_line : {0., 1e-12, -1e-12})
    {
      const Occupancy<dim>   occupancy = ball_on_lines<dim>(off_line);
      const GridWindow<dim> &boxes     = occupancy.window();
      const auto             classes   = classify(occupancy, 0.85);
      unsigned int           n_inner   = 0;
      for (unsigned int number = 0; number < classes.size(); ++number)
        {
          GridIndex<dim> turned = boxes.index(number);
          for (int &i : turned)
            i = -1 - i;
          const unsigned int other    = boxes.number(turned);
          const bool         is_inner = classes[number] == GridCellClass::inner;
          EXPECT_EQ(is_inner, classes[other] == GridCellClass::inner);
          EXPECT_EQ(occupancy.n_quadrature_points(number),
                    occupancy.n_quadrature_points(other));
          n_inner += is_inner;
        }
      EXPECT_GT(n_inner, 0u);
    }
}
