// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_particles_random_points_h
#define morula_tests_particles_random_points_h

#include <morula/particles/point_list.h>
#include <morula/particles/point_store.h>
#include <morula/particles/tissue.h>

#include "common/body_on_grid.h"
#include "common/tests.h"

namespace Morula
{
  /** A number that tells which point, and which place in its row, this is. */
  inline double
  mark(const types::particle_index id, const unsigned int place)
  {
    return 1000. * id + place + 0.125;
  }

  template <int dim>
  void
  append(PointList<dim>             &list,
         const types::particle_index id,
         const Point<dim>           &x)
  {
    std::vector<double> row;
    for (unsigned int i = 0; i < list.n_numbers; ++i)
      row.push_back(mark(id, i));
    list.add(id, x, row);
  }

  /** Marked points, the same on all ranks, within @p reach of the origin by
   *  each coordinate. */
  template <int dim>
  PointList<dim>
  random_points(const unsigned int n,
                const double       reach,
                const unsigned int n_numbers,
                const unsigned int seed)
  {
    std::mt19937   generator(seed);
    PointList<dim> list(n_numbers);
    for (unsigned int i = 0; i < n; ++i)
      append(list,
             (7 * i + 3) % n, // n is no multiple of 7
             Point<dim>(reach * random_tensor<1, dim>(generator)));
    return list;
  }

  /** Cells at these places, each of the volume @p V, numbered. */
  template <int dim>
  PointList<dim>
  cells_at(const std::vector<Point<dim>> &places, const double V)
  {
    const CellColumns<dim> columns;
    PointList<dim>         cells(columns.n_numbers());
    for (const Point<dim> &x : places)
      cells.add(cells.size(), x, columns.founder(x, V));
    return cells;
  }

  /** The points for which select(i) holds. */
  template <int dim, typename Select>
  PointList<dim>
  selected(const PointList<dim> &all, const Select &select)
  {
    PointList<dim> part(all.n_numbers);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (select(i))
        part.add(all.ids[i], all.positions[i], all.row(i));
    return part;
  }

  /** Every rank's share of points known to all, in no relation to the grid. */
  template <int dim>
  PointList<dim>
  dealt(const PointList<dim> &all)
  {
    return selected(all, [](const std::size_t i) {
      return i % number_of_ranks() == this_rank();
    });
  }

  /** Those in grid cells of this rank. */
  template <int dim>
  PointList<dim>
  owned(const PointList<dim> &all, const BackgroundGrid<dim> &grid)
  {
    return selected(all, [&](const std::size_t i) {
      return grid.owner(grid.box().number(
               grid.box().locate(all.positions[i]))) == this_rank();
    });
  }

  /** The same points, with their rows, whatever the order. */
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
          const auto row      = list.row(i);
          result[list.ids[i]] = {list.positions[i], {row.begin(), row.end()}};
        }
      return result;
    };
    EXPECT_EQ(found.n_numbers, expected.n_numbers);
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_EQ(found.positions.size(), found.size());
    EXPECT_EQ(found.numbers.size(), found.size() * found.n_numbers);
    EXPECT_TRUE(rows(found) == rows(expected));
  }

  /** A grid around the points, distributed by them. */
  template <int dim>
  void
  enclose(BackgroundGrid<dim> &grid, const PointList<dim> &all)
  {
    const auto [first, last] = extent<dim>({&all.positions}, grid);
    grid.enclose(first, last);
    GridCellCounts weights; // rank 0 counts all points
    if (this_rank() == 0)
      for (const Point<dim> &x : all.positions)
        weights.push_back({grid.box().number(grid.box().locate(x)), 1});
    grid.partition(weights);
  }
} // namespace Morula

#endif
