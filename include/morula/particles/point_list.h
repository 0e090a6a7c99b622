// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_point_list_h
#define morula_particles_point_list_h

#include <morula/particles/columns.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/point.h>
#include <deal.II/particles/property_pool.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * Plain copies of points (cells or boundary points) on their way from the
   * seeding, from a snapshot, to another rank, or into a file: ids, positions
   * (µm) and a row of numbers each, one row after the other. The points'
   * Columns say what the numbers mean; or they are a value that is Flat.
   */
  template <int dim>
  struct PointList
  {
    /** @param n_numbers in a row */
    explicit PointList(const unsigned int n_numbers = 0)
      : n_numbers(n_numbers)
    {}

    unsigned int                       n_numbers;
    std::vector<types::particle_index> ids;
    std::vector<Point<dim>>            positions;
    std::vector<double>                numbers;

    std::size_t
    size() const
    {
      return ids.size();
    }

    /** Makes room for @p n points. */
    void
    reserve(const std::size_t n)
    {
      ids.reserve(n);
      positions.reserve(n);
      numbers.reserve(n * n_numbers);
    }

    /** Row number @p i. */
    ArrayView<const double>
    row(const std::size_t i) const
    {
      return {numbers.data() + i * n_numbers, n_numbers};
    }

    /** Row number @p i, to be written. */
    ArrayView<double>
    row(const std::size_t i)
    {
      return {numbers.data() + i * n_numbers, n_numbers};
    }

    /** Adds a point at the end. */
    void
    add(const types::particle_index    id,
        const Point<dim>              &position,
        const ArrayView<const double> &row)
    {
      ids.push_back(id);
      positions.push_back(position);
      numbers.insert(numbers.end(), row.begin(), row.end());
    }

    /** Adds the points of another list, whose rows must be as long. */
    void
    append(const PointList &others)
    {
      ids.insert(ids.end(), others.ids.begin(), others.ids.end());
      positions.insert(positions.end(),
                       others.positions.begin(),
                       others.positions.end());
      numbers.insert(numbers.end(),
                     others.numbers.begin(),
                     others.numbers.end());
    }

    /** Adds a point whose row is this value. */
    template <typename T>
    void
    add_value(const types::particle_index id,
              const Point<dim>           &position,
              const T                    &value)
    {
      AssertDimension(n_numbers, Flat<T>::n);
      ids.push_back(id);
      positions.push_back(position);
      append_flat(numbers, value);
    }

    /** The value that add_value() has added as row number @p i. */
    template <typename T>
    T
    value(const std::size_t i) const
    {
      AssertDimension(n_numbers, Flat<T>::n);
      return Flat<T>::read(row(i).data());
    }
  };
} // namespace Morula

#endif
