// ranks: 1 5
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

constexpr double h = 12.5;

GridParameters
grid_parameters()
{
  GridParameters parameters;
  parameters.spacing = h;
  parameters.offset  = {1., -2., 3.};
  return parameters;
}

template <int dim>
GridIndex<dim>
index(const int i, const int j, const int k)
{
  const int      all[3] = {i, j, k};
  GridIndex<dim> result;
  for (unsigned int d = 0; d < dim; ++d)
    result[d] = all[d];
  return result;
}

template <int dim>
GridIndex<dim>
shifted(GridIndex<dim> i, const unsigned int d, const int by)
{
  i[d] += by;
  return i;
}

/** Each grid cell of the box has one owner, which has its cell. */
template <int dim>
void
expect_tables(const BackgroundGrid<dim> &grid)
{
  const unsigned int        rank    = this_rank();
  const unsigned int        n_ranks = number_of_ranks();
  std::vector<unsigned int> owners, largest;
  for (unsigned int number = 0; number < grid.box().size(); ++number)
    owners.push_back(grid.owner(number));
  largest = owners;
  Utilities::MPI::max(owners, MPI_COMM_WORLD, largest);
  EXPECT_EQ(owners, largest); // the same table on all ranks
  unsigned int n_owned = 0;
  for (unsigned int number = 0; number < grid.box().size(); ++number)
    {
      EXPECT_LT(grid.owner(number), n_ranks);
      const auto grid_cell = grid.grid_cell(number);
      EXPECT_EQ(grid_cell != grid.triangulation().end(),
                grid.owner(number) == rank);
      if (grid.owner(number) != rank)
        continue;
      ++n_owned;
      EXPECT_TRUE(grid_cell->is_locally_owned());
      const auto i = grid.box().index(number);
      EXPECT_LT(grid_cell->center().distance(grid.box().center(i)), 1e-10);
      EXPECT_NEAR(grid_cell->extent_in_direction(0), h, 1e-10);
      for (unsigned int d = 0; d < dim; ++d)
        EXPECT_NEAR(grid_cell->center()[d],
                    grid_parameters().offset.value()[d] + (i[d] + 0.5) * h,
                    1e-10);
    }
  EXPECT_EQ(sum_over_ranks(n_owned), grid.box().size());
}


TEST_2D_3D(BackgroundGrid, EnclosesTheTissueWithPadding)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  BackgroundGrid<dim> grid(grid_parameters(), MPI_COMM_WORLD);
  const auto          first = index<dim>(-5, 2, -1);
  const auto          last  = index<dim>(4, 2, 9);
  EXPECT_FALSE(grid.covers(first, last));
  grid.enclose(first, last);
  EXPECT_TRUE(grid.covers(first, last));
  for (unsigned int d = 0; d < dim; ++d)
    {
      // Two grid cells of padding at least, of which one is spare.
      EXPECT_LE(grid.box().first()[d], first[d] - 2);
      EXPECT_GE(grid.box().first()[d] + grid.box().n()[d], last[d] + 3);
      EXPECT_TRUE(
        grid.covers(shifted<dim>(first, d, -1), shifted<dim>(last, d, 1)));
      EXPECT_FALSE(
        grid.covers(first, shifted<dim>(last, d, grid.box().n()[d])));
      EXPECT_FALSE(
        grid.covers(shifted<dim>(first, d, -grid.box().n()[d]), last));
    }
  expect_tables(grid);

  // Larger, smaller, elsewhere.
  for (const int shift : {3, -40})
    {
      grid.enclose(shifted<dim>(first, 1, shift), shifted<dim>(last, 0, 9));
      EXPECT_TRUE(
        grid.covers(shifted<dim>(first, 1, shift), shifted<dim>(last, 0, 9)));
      expect_tables(grid);
    }
}


TEST_2D_3D(BackgroundGrid, IsMadeAgainForAGivenBox)
{
  BackgroundGrid<dim> grid(grid_parameters(), MPI_COMM_WORLD);
  const auto          first = index<dim>(-8, 4, 0);
  const auto          n     = index<dim>(8, 4, 12);
  grid.make(first, n);
  EXPECT_EQ(grid.box().first(), first);
  EXPECT_EQ(grid.box().n(), n);
  EXPECT_TRUE(grid.weights().empty());
  expect_tables(grid);
  // The outermost layer is not covered: its neighbours lie outside.
  EXPECT_TRUE(grid.covers(index<dim>(-7, 5, 1), index<dim>(-2, 6, 10)));
  EXPECT_FALSE(grid.covers(index<dim>(-7, 5, 1), index<dim>(-1, 6, 10)));
  EXPECT_FALSE(grid.covers(index<dim>(-8, 5, 1), index<dim>(-2, 6, 10)));
}


// All points in one corner of the box: all ranks get their share of them.
TEST_2D_3D(BackgroundGrid, IsDistributedByPoints)
{
  const unsigned int  n_ranks = number_of_ranks();
  BackgroundGrid<dim> grid(grid_parameters(), MPI_COMM_WORLD);
  grid.make(index<dim>(0, 0, 0), index<dim>(16, 16, 16));
  std::vector<unsigned int> weights(grid.box().size(), 0);
  GridCellCounts            given; // rank 0 gives all of them
  double                    total = 0.;
  for (unsigned int number = 0; number < weights.size(); ++number)
    {
      bool corner = true;
      for (const int i : grid.box().index(number))
        corner = corner && i < 8;
      if (corner)
        weights[number] = 1000;
      if (corner && this_rank() == 0)
        given.push_back({number, 1000});
      total += weights[number];
    }
  grid.partition(given);
  expect_tables(grid);
  EXPECT_EQ(grid.total_weight(), total);
  unsigned int sum = 0;
  for (const GridCellCount &weight : grid.weights())
    {
      EXPECT_EQ(weight.n, weights[weight.number]);
      sum += weight.n;
    }
  EXPECT_EQ(sum_over_ranks(sum), total);
  std::vector<double> loads(n_ranks, 0.);
  for (unsigned int number = 0; number < weights.size(); ++number)
    loads[grid.owner(number)] += weights[number];
  for (const double load : loads)
    // A family of grid cells stays together, an empty one counts as a point.
    EXPECT_NEAR(load,
                total / n_ranks,
                1000. * Utilities::pow(2, dim) + weights.size());
}


// Boxes of few grid cells, all points in one of them: some ranks may own no
// leaf at all.
TEST_2D_3D(BackgroundGrid, MayLeaveRanksWithoutGridCells)
{
  BackgroundGrid<dim> grid(grid_parameters(), MPI_COMM_WORLD);
  for (const int n : {1, 2, 3, 5})
    for (const int other : {1, 2})
      {
        grid.make(index<dim>(-1, 7, 2), index<dim>(n, other, 1));
        expect_tables(grid);
        for (unsigned int heavy = 0; heavy < grid.box().size(); ++heavy)
          {
            GridCellCounts weights;
            for (const auto &grid_cell : grid.owned_grid_cells())
              if (grid_cell.number == heavy)
                weights.push_back({heavy, 1000});
            grid.partition(weights);
            expect_tables(grid);
          }
      }
}


// Two ranks part a box by a plane across its longest direction, the first of
// equal ones.
TEST_2D_3D(BackgroundGrid, IsCutAcrossItsLength)
{
  MPI_Comm pair; // ranks 0 and 1, 2 and 3, ...
  MPI_Comm_split(MPI_COMM_WORLD, this_rank() / 2, 0, &pair);
  if (number_of_ranks(pair) != 2)
    return;
  BackgroundGrid<dim> grid(grid_parameters(), pair);
  for (unsigned int longest = 0; longest < dim; ++longest)
    for (const int other : {6, 10, 24})
      {
        auto n     = index<dim>(other, other, other);
        n[longest] = 24;
        grid.make(index<dim>(-3, 5, 1), n);
        GridCellCounts weights;
        for (const auto &grid_cell : grid.owned_grid_cells())
          weights.push_back({grid_cell.number, 7});
        grid.partition(weights);
        const unsigned int across = other == 24 ? 0 : longest;
        const GridBox<dim> box    = grid.box();
        for (unsigned int number = 0; number < box.size(); ++number)
          EXPECT_EQ(grid.owner(number),
                    box.index(number)[across] - box.first()[across] < 12 ? 0 :
                                                                           1)
            << other << " grid cells, and 24 along " << longest;
      }
}


TEST(BackgroundGrid, LocatesPointsBetweenGridLines)
{
  const BackgroundGrid<3> grid(grid_parameters(), MPI_COMM_WORLD);
  EXPECT_EQ(grid.locate(Point<3>(1., -2., 3.)), (index<3>(0, 0, 0)));
  EXPECT_EQ(grid.locate(Point<3>(0.9, -2.1, 15.6)), (index<3>(-1, -1, 1)));
}
