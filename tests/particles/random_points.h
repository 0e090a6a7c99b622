// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_particles_random_points_h
#define morula_tests_particles_random_points_h

#include <morula/particles/point_list.h>
#include <morula/particles/point_store.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "common/body_on_grid.h"

namespace Morula
{
  /** A property that tells which point, and which of its slots, this is. */
  inline double
  mark(const types::particle_index id, const unsigned int slot)
  {
    return 1000. * id + slot + 0.125;
  }

  template <int dim>
  void
  append(PointList<dim>             &list,
         const types::particle_index id,
         const Point<dim>           &x)
  {
    list.ids.push_back(id);
    list.positions.push_back(x);
    for (unsigned int slot = 0; slot < list.n_slots; ++slot)
      list.properties.push_back(mark(id, slot));
  }

  /** Marked points, the same on all ranks, within @p reach of the origin by
   *  each coordinate. */
  template <int dim>
  PointList<dim>
  random_points(const unsigned int n,
                const double       reach,
                const unsigned int n_slots,
                const unsigned int seed)
  {
    std::mt19937   generator(seed);
    PointList<dim> list;
    list.n_slots = n_slots;
    for (unsigned int i = 0; i < n; ++i)
      append(list,
             (7 * i + 3) % n, // n is no multiple of 7
             Point<dim>(reach * random_tensor<1, dim>(generator)));
    return list;
  }

  /** The points for which select(i) holds. */
  template <int dim, typename Select>
  PointList<dim>
  selected(const PointList<dim> &all, const Select &select)
  {
    PointList<dim> part;
    part.n_slots = all.n_slots;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (select(i))
        {
          part.ids.push_back(all.ids[i]);
          part.positions.push_back(all.positions[i]);
          const auto first = all.properties.begin() + i * all.n_slots;
          part.properties.insert(part.properties.end(),
                                 first,
                                 first + all.n_slots);
        }
    return part;
  }

  /** Every rank's share of points known to all, in no relation to the grid. */
  template <int dim>
  PointList<dim>
  dealt(const PointList<dim> &all)
  {
    return selected(all, [](const std::size_t i) {
      return i % Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) ==
             Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    });
  }

  /** Those in grid cells of this rank. */
  template <int dim>
  PointList<dim>
  owned(const PointList<dim> &all, const BackgroundGrid<dim> &grid)
  {
    return selected(all, [&](const std::size_t i) {
      return grid.owner(
               grid.box().number(grid.box().locate(all.positions[i]))) ==
             Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    });
  }

  /** The same points, with their properties, whatever the order. */
  template <int dim>
  void
  expect_same_points(const PointList<dim> &found,
                     const PointList<dim> &expected)
  {
    const auto rows = [](const PointList<dim> &list) {
      std::map<types::particle_index,
               std::pair<Point<dim>, std::vector<double>>>
        result;
      for (std::size_t i = 0; i < list.size(); ++i)
        {
          const auto first    = list.properties.begin() + i * list.n_slots;
          result[list.ids[i]] = {list.positions[i],
                                 {first, first + list.n_slots}};
        }
      return result;
    };
    EXPECT_EQ(found.n_slots, expected.n_slots);
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_EQ(found.positions.size(), found.size());
    EXPECT_EQ(found.properties.size(), found.size() * found.n_slots);
    EXPECT_TRUE(rows(found) == rows(expected));
  }

  /** A grid around the points, distributed by them. */
  template <int dim>
  void
  enclose(BackgroundGrid<dim> &grid, const PointList<dim> &all)
  {
    const auto [first, last] = extent<dim>({&all.positions}, grid);
    grid.enclose(first, last);
    std::vector<unsigned int> weights(grid.box().size(), 0);
    for (const Point<dim> &x : all.positions)
      ++weights[grid.box().number(grid.box().locate(x))];
    grid.partition(weights);
  }
} // namespace Morula

#endif
