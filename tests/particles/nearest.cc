// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

/** Ids of the nearest points, found by looking at all of them. */
template <int dim>
std::set<types::particle_index>
nearest_ids(const Point<dim> &query, const PointList<dim> &all)
{
  double shortest = std::numeric_limits<double>::max();
  for (const Point<dim> &x : all.positions)
    shortest = std::min(shortest, query.distance(x));
  std::set<types::particle_index> ids;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (query.distance(all.positions[i]) <= shortest * (1. + 1e-9))
      ids.insert(all.ids[i]);
  return ids;
}

/** Compares with the oracle for those of the queries that are this rank's. */
template <int dim>
void
expect_nearest(const std::vector<Point<dim>> &all_queries,
               const PointList<dim>          &all)
{
  BackgroundGrid<dim> grid(GridParameters(), MPI_COMM_WORLD);
  PointList<dim>      everything = all;
  for (const Point<dim> &query : all_queries)
    append(everything, 0, query);
  enclose(grid, everything);
  std::vector<Point<dim>> queries;
  for (const Point<dim> &query : all_queries)
    if (grid.owner(grid.box().number(grid.box().locate(query))) == this_rank())
      queries.push_back(query);
  PointStore<dim> store(all.n_numbers);
  store.attach(grid);
  store.insert(owned(all, grid), grid);
  const auto append = [&](const unsigned int p, std::vector<double> &list) {
    for (unsigned int i = 0; i < all.n_numbers; ++i)
      list.push_back(mark(store.id(p), i));
  };
  for (const Ties ties : {Ties::lowest_id, Ties::mean})
    {
      const auto found =
        nearest_numbers(queries, store, {all.n_numbers, append, ties}, grid);
      ASSERT_EQ(found.size(), queries.size() * all.n_numbers);
      for (std::size_t q = 0; q < queries.size(); ++q)
        for (unsigned int i = 0; i < all.n_numbers; ++i)
          {
            const auto ids  = nearest_ids(queries[q], all);
            double     mean = 0.;
            for (const auto id : ids)
              mean += mark(id, i) / ids.size();
            const double expected =
              ties == Ties::mean ? mean : mark(*ids.begin(), i);
            EXPECT_NEAR(found[q * all.n_numbers + i],
                        expected,
                        ties == Ties::mean ? 1e-12 * std::abs(expected) : 0.)
              << queries[q];
          }
    }

  // The same as values.
  const auto values = nearest_values(
    queries,
    store,
    [&](const unsigned int p) {
      return std::tuple(store.position(p), static_cast<int>(store.id(p)));
    },
    Ties::lowest_id,
    grid);
  ASSERT_EQ(values.size(), queries.size());
  for (std::size_t q = 0; q < queries.size(); ++q)
    {
      const auto &[x, id] = values[q];
      EXPECT_EQ(id, static_cast<int>(*nearest_ids(queries[q], all).begin()));
      EXPECT_EQ(x,
                all.positions[std::find(all.ids.begin(),
                                        all.ids.end(),
                                        static_cast<unsigned int>(id)) -
                              all.ids.begin()]);
    }
}


TEST_2D_3D(Nearest, AgreesWithLookingAtAllPoints)
{
  for (const unsigned int n : {2u, 20u, 600u})
    expect_nearest<dim>(random_points<dim>(200, 200., 0, n + 1).positions,
                        random_points<dim>(n, 180., 2, n));
}


// Queries at the grid's and the lattice's own symmetry points.
TEST_2D_3D(Nearest, TiesGoToTheLowestIdOrTheMean)
{
  const double   spacing = 25.;
  const auto     sites   = lattice_points<dim>(100., spacing);
  PointList<dim> all(1);
  for (std::size_t i = 0; i < sites.size(); ++i)
    append<dim>(all, (i * 31) % sites.size(), sites[i]);
  std::vector<Point<dim>> queries;
  for (const Point<dim> &x : sites)
    {
      Point<dim> corner = x;
      for (unsigned int d = 0; d < dim; ++d)
        corner[d] += 0.5 * spacing;
      queries.push_back(corner); // 2^dim at the same distance
      corner[0] = x[0];
      queries.push_back(corner);
    }
  expect_nearest(queries, all);
}


// The only point stands in the opposite corner of a large box.
TEST_2D_3D(Nearest, MayBeFarAway)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  for (const double distance : {200., 990., 1300.})
    {
      PointList<dim> all(1);
      Point<dim>     x, query;
      for (unsigned int d = 0; d < dim; ++d)
        {
          x[d]     = 10.;
          query[d] = distance;
        }
      append(all, 4, x);
      expect_nearest<dim>({query}, all);
    }
}
