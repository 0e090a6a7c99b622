// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/nearest.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "particles/random_points.h"

using namespace Morula;

namespace
{
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
      if (grid.owner(grid.box().number(grid.box().locate(query))) ==
          Utilities::MPI::this_mpi_process(MPI_COMM_WORLD))
        queries.push_back(query);
    PointStore<dim> store(all.n_slots);
    store.attach(grid);
    store.insert(owned(all, grid), grid);
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      const auto properties = store.properties(p);
      list.insert(list.end(), properties.begin(), properties.end());
    };
    for (const bool mean_of_ties : {false, true})
      {
        const auto found = nearest_properties(
          queries, store, {all.n_slots, append, mean_of_ties}, grid);
        ASSERT_EQ(found.size(), queries.size() * all.n_slots);
        for (std::size_t q = 0; q < queries.size(); ++q)
          for (unsigned int slot = 0; slot < all.n_slots; ++slot)
            {
              const auto ids  = nearest_ids(queries[q], all);
              double     mean = 0.;
              for (const auto id : ids)
                mean += mark(id, slot) / ids.size();
              const double expected =
                mean_of_ties ? mean : mark(*ids.begin(), slot);
              EXPECT_NEAR(found[q * all.n_slots + slot],
                          expected,
                          mean_of_ties ? 1e-12 * std::abs(expected) : 0.)
                << queries[q];
            }
      }
  }

  template <int dim>
  void
  check_random()
  {
    for (const unsigned int n : {2u, 20u, 600u})
      expect_nearest<dim>(random_points<dim>(200, 200., 0, n + 1).positions,
                          random_points<dim>(n, 180., 2, n));
  }

  /** Queries at the grid's and the lattice's own symmetry points. */
  template <int dim>
  void
  check_ties()
  {
    const double spacing = 25.;
    const auto   sites =
      lattice_points<dim>(Point<dim>(), 100., spacing, [](const auto &) {
        return true;
      });
    PointList<dim> all;
    all.n_slots = 1;
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

  /** The only point stands in the opposite corner of a large box. */
  template <int dim>
  void
  check_far()
  {
    for (const double distance : {200., 990., 1300.})
      {
        PointList<dim> all;
        all.n_slots = 1;
        Point<dim> x, query;
        for (unsigned int d = 0; d < dim; ++d)
          {
            x[d]     = 10.;
            query[d] = distance;
          }
        append(all, 4, x);
        expect_nearest<dim>({query}, all);
      }
  }
} // namespace


TEST(Nearest,
     AgreesWithLookingAtAllPoints){MORULA_BOTH_DIMENSIONS(check_random)}


TEST(Nearest, TiesGoToTheLowestIdOrTheMean){MORULA_BOTH_DIMENSIONS(check_ties)}


TEST(Nearest, MayBeFarAway)
{
  MORULA_BOTH_DIMENSIONS(check_far)
}
