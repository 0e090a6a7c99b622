// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_nearest_h
#define morula_particles_nearest_h

#include <morula/grid/background_grid.h>
#include <morula/particles/point_store.h>

#include <functional>
#include <type_traits>
#include <vector>

namespace Morula
{
  /** Which points count if several are equally near. */
  enum class Ties
  {
    mean,     // the mean of all of them: the same in any frame
    lowest_id // only the one with the lowest id
  };

  /** The numbers that a query asks of a point, which is given by its position p
   *  in the canonical order: append(p, list) adds @p n numbers to the list. */
  struct NearestQuery
  {
    unsigned int                                             n;
    std::function<void(unsigned int, std::vector<double> &)> append;
    Ties                                                     ties;
  };

  /**
   * The wanted numbers of the point nearest to each query position, over all
   * ranks, query by query. Queries lie in grid cells of this rank. Only points
   * near some query are sent. Collective.
   */
  template <int dim>
  std::vector<double>
  nearest_numbers(const std::vector<Point<dim>> &queries,
                  const PointStore<dim>         &points,
                  const NearestQuery            &wanted,
                  const BackgroundGrid<dim>     &grid);

  /** The same for the values value(p) of a type that is Flat. */
  template <int dim, typename Value>
  auto
  nearest_values(const std::vector<Point<dim>> &queries,
                 const PointStore<dim>         &points,
                 const Value                   &value,
                 const Ties                     ties,
                 const BackgroundGrid<dim>     &grid)
  {
    using T           = std::invoke_result_t<Value, unsigned int>;
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      append_flat(list, value(p));
    };
    const std::vector<double> numbers =
      nearest_numbers(queries, points, {Flat<T>::n, append, ties}, grid);
    std::vector<T> values;
    for (std::size_t first = 0; first < numbers.size(); first += Flat<T>::n)
      values.push_back(Flat<T>::read(&numbers[first]));
    return values;
  }
} // namespace Morula

#endif
