// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

/** Order, grid cells and rows of a store that holds these points. */
template <int dim>
void
expect_store(const PointStore<dim>     &store,
             const BackgroundGrid<dim> &grid,
             const PointList<dim>      &all)
{
  expect_same_points(store.copy(), owned(all, grid));
  unsigned int end = 0, last_number = 0;
  for (const auto &cell : store.grid_cells())
    {
      EXPECT_TRUE(end == 0 || cell.number > last_number);
      EXPECT_EQ(cell.begin, end);
      EXPECT_GT(cell.end, cell.begin);
      for (unsigned int p = cell.begin; p < cell.end; ++p)
        {
          EXPECT_EQ(grid.box().number(grid.box().locate(store.position(p))),
                    cell.number);
          if (p > cell.begin)
            {
              EXPECT_LT(store.id(p - 1), store.id(p));
            }
        }
      last_number = cell.number;
      end         = cell.end;
    }
  EXPECT_EQ(end, store.size());
}

/** A store whose rows can be looked at. */
template <int dim>
class OpenStore : public PointStore<dim>
{
public:
  using PointStore<dim>::PointStore;

  /** In memory each row stands behind the one before. */
  bool
  is_in_order_in_memory() const
  {
    for (unsigned int p = 1; p < this->size(); ++p)
      if (this->row(p).begin() != this->row(p - 1).end())
        return false;
    return true;
  }
};


TEST_2D_3D(PointStore, HoldsEachPointWhereItsGridCellIsOwned)
{
  const auto          all = random_points<dim>(500, 170., 5, 1);
  BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
  enclose(grid, all);
  PointStore<dim> store(5);
  store.attach(grid);
  store.insert(dealt(all), grid);
  expect_store(store, grid, all);

  // Again, from one rank only, and in two portions.
  expect_same_points(store.take(), owned(all, grid));
  EXPECT_EQ(store.size(), 0u);
  EXPECT_TRUE(store.grid_cells().empty());
  const auto portion = [&](const std::size_t begin, const std::size_t end) {
    return selected(all, [&](const std::size_t i) {
      return i >= begin && i < end && this_rank() == 0;
    });
  };
  store.insert(portion(300, 500), grid);
  store.insert(portion(0, 300), grid);
  expect_store(store, grid, all);
}


TEST_2D_3D(PointStore, RemovesPoints)
{
  const auto          all = random_points<dim>(300, 120., 2, 2);
  BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
  enclose(grid, all);
  PointStore<dim> store(2);
  store.attach(grid);
  store.insert(dealt(all), grid);
  std::vector<unsigned int> removed;
  for (unsigned int p = 0; p < store.size(); ++p)
    if (store.id(p) % 3 == 0)
      removed.push_back(p);
  store.replace(removed, PointList<dim>(), grid);
  expect_store(store, grid, selected(all, [&](const std::size_t i) {
                 return all.ids[i] % 3 != 0;
               }));
}


// Points that stay in their grid cell, leave it, and leave their rank, with
// numbers written in place.
TEST_2D_3D(PointStore, MovesPoints)
{
  for (const double distance : {3., 30., 150.})
    {
      const auto          all = random_points<dim>(500, 200., 2, 7);
      auto                end = all;
      BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
      for (std::size_t i = 0; i < end.size(); ++i)
        {
          for (unsigned int d = 0; d < dim; ++d)
            end.positions[i][d] +=
              (((i + d) % 3) - 1.) * distance * (1. + 1e-3 * i);
          end.row(i)[0] = -1. * end.ids[i];
        }
      PointList<dim> both = all;
      both.ids.insert(both.ids.end(), end.ids.begin(), end.ids.end());
      both.positions.insert(both.positions.end(),
                            end.positions.begin(),
                            end.positions.end());
      enclose(grid, both);
      std::map<types::particle_index, Point<dim>> targets;
      for (std::size_t i = 0; i < end.size(); ++i)
        targets[end.ids[i]] = end.positions[i];

      Columns    columns;
      const auto first = columns.add<double>({"first", "", ""});
      columns.add<double>({"second", "", ""});
      PointStore<dim> store(columns.n_numbers());
      store.attach(grid);
      store.insert(dealt(all), grid);
      std::vector<Point<dim>> positions;
      for (unsigned int p = 0; p < store.size(); ++p)
        {
          positions.push_back(targets.at(store.id(p)));
          store.set(first, p, -1. * store.id(p));
        }
      store.move(positions, grid);
      expect_store(store, grid, end);
    }
}


TEST_2D_3D(PointStore, KeepsPointsInOrderInMemory)
{
  const auto          all = random_points<dim>(500, 120., 3, 4);
  BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
  enclose(grid, all);
  OpenStore<dim> store(3);
  store.attach(grid);
  store.insert(dealt(all), grid);
  EXPECT_TRUE(store.is_in_order_in_memory());

  // Few points out of order stay so, many are mended.
  for (const unsigned int n : {5u, 100u})
    {
      std::vector<unsigned int> removed;
      for (unsigned int p = 0; p < store.size(); ++p)
        if (store.id(p) < n)
          removed.push_back(p);
      const auto again =
        selected(all, [&](const std::size_t i) { return all.ids[i] < n; });
      store.replace({removed.rbegin(), removed.rend()}, dealt(again), grid);
      store.defragment(grid);
      expect_store(store, grid, all);
    }
  EXPECT_TRUE(store.is_in_order_in_memory());
}


TEST_2D_3D(PointStore, CountsPointsOverAllRanks)
{
  const auto          all = random_points<dim>(400, 110., 0, 3);
  BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
  const auto          mine = dealt(all);
  const auto [first, last] = extent<dim>({&mine.positions}, grid);
  enclose(grid, all);
  std::vector<unsigned int> counts(grid.box().size(), 0);
  GridIndex<dim>            lowest, highest;
  lowest.fill(1000);
  highest.fill(-1000);
  for (const Point<dim> &x : all.positions)
    {
      const auto index = grid.locate(x);
      ++counts[grid.box().number(index)];
      for (unsigned int d = 0; d < dim; ++d)
        {
          lowest[d]  = std::min(lowest[d], index[d]);
          highest[d] = std::max(highest[d], index[d]);
        }
    }
  EXPECT_EQ(first, lowest);
  EXPECT_EQ(last, highest);
  unsigned int n_owned = 0;
  for (const GridCellCount &count : count_points(mine.positions, grid))
    {
      EXPECT_EQ(grid.owner(count.number), this_rank());
      EXPECT_EQ(count.n, counts[count.number]);
      n_owned += count.n;
    }
  EXPECT_EQ(sum_over_ranks(n_owned), all.positions.size());
}
