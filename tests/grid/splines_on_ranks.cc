// ranks: 5
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

/** Bodies through the parts of many ranks: a long U, whose arms are one piece
 *  by its bend alone, a needle across the grid's lines, a block, and a cell.
 */
template <int dim>
std::vector<Point<dim>>
long_bodies()
{
  constexpr double end     = 30. * h;
  const double     spacing = cell_spacing<dim>();
  auto             points  = lattice_points<dim>(
    Point<dim>(), end + 3. * h, spacing, [&](const auto &x) {
      const auto within = [&](const unsigned int d, double from, double to) {
        return x[d] > from * h && x[d] < to * h;
      };
      const bool thick = dim == 2 || within(dim - 1, 0., 2.3);
      const bool arms =
        (within(1, 0., 2.) || within(1, 4., 6.)) && within(0, -30., 30.);
      const bool bend = within(0, 27., 30.) && within(1, 0., 6.);
      const bool block = within(0, -29., -26.) && within(1, 9., 12.);
      const bool needle = std::abs(x[1] - 8. * h - 0.3 * x[0]) < 0.3 * h &&
                          within(0, 0., 20.) &&
                          (dim == 2 || within(dim - 1, 0., 0.6));
      return (thick && (arms || bend || block)) || needle;
    });
  Point<dim> lone;
  lone[0] = -10. * h;
  lone[1] = 12. * h;
  points.push_back(lone);
  return points;
}


// Every number of ranks gives the same splines.
TEST_2D_3D(SplinesOnRanks, IsTheSameForAnyNumberOfRanks)
{
  for (unsigned int seed = 0; seed <= (dim == 2 ? 3 : 1); ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const auto points =
        seed == 0 ? long_bodies<dim>() : random_body<dim>(seed);
      const auto  shared = body<dim>(points);
      const auto  alone  = body<dim>(points, MPI_COMM_SELF);
      const auto &space  = *shared.space;
      if (seed == 0)
        {
          EXPECT_EQ(alone.space->n_pieces(), 4u);
        }
      EXPECT_EQ(space.n_unknowns(), alone.space->n_unknowns());
      EXPECT_EQ(space.n_active_grid_cells(),
                alone.space->n_active_grid_cells());
      EXPECT_EQ(space.n_inner_splines(), alone.space->n_inner_splines());
      EXPECT_EQ(space.n_outer_splines(), alone.space->n_outer_splines());
      EXPECT_EQ(space.n_pieces(), alone.space->n_pieces());
      EXPECT_EQ(sum_over_ranks<unsigned int>(space.grid_cells().size()),
                alone.space->n_active_grid_cells());
      EXPECT_EQ(sum_over_ranks<unsigned int>(space.owned().n_elements()),
                space.n_unknowns());
      EXPECT_EQ((space.owned() & space.relevant()), space.owned());

      // Coefficients that tell the splines apart.
      const auto wild = [](const Point<dim> &c) {
        Tensor<1, dim> value;
        for (unsigned int d = 0; d < dim; ++d)
          value[d] = std::sin(0.7 * c[0] + (d + 1.3) * c[1] + c[dim - 1]);
        return value;
      };
      const auto   fields = shared.fields(shared.interpolate(wild));
      const auto   whole  = alone.fields(alone.interpolate(wild));
      unsigned int k      = 0;
      for (unsigned int c = 0; c < fields.size(); ++c)
        {
          while (alone.space->grid_cells()[k].number !=
                 space.grid_cells()[c].number)
            ++k;
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
              EXPECT_NEAR(fields[c].coefficient[i][b],
                          whole[k].coefficient[i][b],
                          1e-10);
          EXPECT_EQ(space.piece(space.grid_cells()[c].number),
                    alone.space->piece(space.grid_cells()[c].number));
        }
    }
}
