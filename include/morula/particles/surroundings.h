// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_surroundings_h
#define morula_particles_surroundings_h

#include <morula/particles/nearest.h>
#include <morula/particles/tissue.h>

#include <utility>
#include <vector>

namespace Morula
{
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

  private:
    /** A cell, by its place in what near_points() returns, and its weight. */
    using Share = std::pair<std::size_t, double>;

    const std::vector<Point<dim>>   places;
    const Cells<dim>               &cells;
    const BackgroundGrid<dim>      &grid;
    std::vector<std::vector<Share>> shares; // of each place
  };

  template <int dim>
  template <typename Value>
  auto
  Surroundings<dim>::values(const Value &value) const
  {
    using T           = std::invoke_result_t<Value, unsigned int>;
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      append_flat(list, value(p));
    };
    const PointList<dim> near = near_points(
      places, cells, {Flat<T>::n, append, Ties::lowest_id}, grid, 1);
    std::vector<T> result;
    for (const auto &of_place : shares)
      {
        T sum{};
        for (const auto &[i, weight] : of_place)
          sum += weight * near.template value<T>(i);
        result.push_back(sum);
      }
    return result;
  }
} // namespace Morula

#endif
