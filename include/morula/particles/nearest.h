// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_nearest_h
#define morula_particles_nearest_h

#include <morula/base/send_records.h>
#include <morula/grid/background_grid.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/point_store.h>
#include <morula/particles/tissue.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <type_traits>
#include <unordered_map>
#include <utility>
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
   * The wanted numbers of all points in the grid cells at most @p radius grid
   * cells away from that of some query, of all ranks. Queries lie in grid cells
   * of this rank. Collective.
   */
  template <int dim>
  PointList<dim>
  near_points(const std::vector<Point<dim>> &queries,
              const PointStore<dim>         &points,
              const NearestQuery            &wanted,
              const BackgroundGrid<dim>     &grid,
              const int                      radius);

  /**
   * The wanted numbers of the point nearest to each query position, over all
   * ranks, query by query. Queries lie in grid cells of this rank. Only points
   * near some query are sent. Collective.
   * @param sides of the queries, if only points on the same side count; others
   *        count where theirs has no point left, or none near
   */
  template <int dim>
  std::vector<double>
  nearest_numbers(const std::vector<Point<dim>> &queries,
                  const PointStore<dim>         &points,
                  const NearestQuery            &wanted,
                  const BackgroundGrid<dim>     &grid,
                  const std::vector<Side<dim>>  &sides = {});

  /** As nearest_numbers(), for the values value(p) of a type that is Flat. */
  template <int dim, typename Value>
  auto
  nearest_values(const std::vector<Point<dim>> &queries,
                 const PointStore<dim>         &points,
                 const Value                   &value,
                 const Ties                     ties,
                 const BackgroundGrid<dim>     &grid,
                 const std::vector<Side<dim>>  &sides = {})
  {
    using T           = std::invoke_result_t<Value, unsigned int>;
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      append_flat(list, value(p));
    };
    const std::vector<double> numbers =
      nearest_numbers(queries, points, {Flat<T>::n, append, ties}, grid, sides);
    std::vector<T> values;
    for (std::size_t first = 0; first < numbers.size(); first += Flat<T>::n)
      values.push_back(Flat<T>::read(&numbers[first]));
    return values;
  }

  /**
   * The values value(p) of the points with these ids, one for each query
   * position, as far as they are at most two grid cells away from it: others
   * count as gone. Which are does not depend on the number of ranks.
   * Collective.
   */
  template <int dim, typename Value>
  auto
  values_by_id(const std::vector<types::particle_index> &ids,
               const std::vector<Point<dim>>            &queries,
               const PointStore<dim>                    &points,
               const Value                              &value,
               const BackgroundGrid<dim>                &grid)
  {
    using T              = std::invoke_result_t<Value, unsigned int>;
    constexpr int radius = 2;
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      append_flat(list, value(p));
    };
    const PointList<dim> near = near_points(
      queries, points, {Flat<T>::n, append, Ties::lowest_id}, grid, radius);
    std::unordered_map<types::particle_index, std::size_t> places;
    for (std::size_t i = 0; i < near.size(); ++i)
      places.emplace(near.ids[i], i);

    std::vector<std::optional<T>> values(ids.size());
    for (std::size_t k = 0; k < ids.size(); ++k)
      {
        const auto place = places.find(ids[k]);
        if (place == places.end())
          continue;
        // Other queries of this rank may have asked for points farther away.
        const GridIndex<dim> here = grid.box().locate(queries[k]),
                             there =
                               grid.box().locate(near.positions[place->second]);
        bool is_near = true;
        for (unsigned int d = 0; d < dim; ++d)
          is_near = is_near && std::abs(here[d] - there[d]) <= radius;
        if (is_near)
          values[k] = near.template value<T>(place->second);
      }
    return values;
  }


  /**
   * The cells around some places, and the weights with which their values make
   * up the value there, doc/theory.md (4.6c): moving least squares. The weights
   * reproduce values that depend linearly on the position, so that a place
   * beside the tissue gets what the cells' values tend to. They change smoothly
   * with the positions, so that no single cell decides. Keeps references to the
   * tissue; valid until its cells move.
   */
  template <int dim>
  class Surroundings
  {
  public:
    /** Finds them for places (µm) in grid cells of this rank, among cells of
     *  their @p sides where they have some. A place without a cell nearer than
     *  3/4 of a grid spacing has none. Collective. */
    Surroundings(const std::vector<Point<dim>> &places,
                 const Tissue<dim>             &tissue,
                 const std::vector<Side<dim>>  &sides = {});

    /** The values at the places, from those of the cells, value(p) for cell p
     *  of this rank; zero where there are no cells. Collective. */
    template <typename Value>
    auto
    values(const Value &value) const;

    /** The cells of this rank that values() asks for, in order. */
    std::vector<unsigned int>
    asked_here() const;

  private:
    /** A cell, by its place among all that count here, and its weight. */
    using Share = std::pair<std::size_t, double>;

    const MPI_Comm                  comm;
    std::vector<std::vector<Share>> shares; // of each place
    /** The cells of this rank that count, by the rank where they do. */
    std::map<unsigned int, std::vector<unsigned int>> asked;
  };

  template <int dim>
  template <typename Value>
  auto
  Surroundings<dim>::values(const Value &value) const
  {
    using T = std::invoke_result_t<Value, unsigned int>;
    std::map<unsigned int, std::vector<double>> answers;
    for (const auto &[rank, list] : asked)
      for (const unsigned int p : list)
        append_flat(answers[rank], value(p));
    const std::vector<double> numbers = in_one(send_records(answers, comm));
    std::vector<T>            result;
    for (const auto &of_place : shares)
      {
        std::array<double, Flat<T>::n> sum{};
        for (const auto &[i, weight] : of_place)
          for (unsigned int n = 0; n < Flat<T>::n; ++n)
            sum[n] += weight * numbers[i * Flat<T>::n + n];
        result.push_back(Flat<T>::read(sum.data()));
      }
    return result;
  }
} // namespace Morula

#endif
