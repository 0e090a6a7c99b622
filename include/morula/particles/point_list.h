// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_point_list_h
#define morula_particles_point_list_h

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
   * (µm) and @p n_slots properties each, one after the other.
   */
  template <int dim>
  struct PointList
  {
    unsigned int                       n_slots = 0;
    std::vector<types::particle_index> ids;
    std::vector<Point<dim>>            positions;
    std::vector<double>                properties;

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
      properties.reserve(n * n_slots);
    }

    /** Adds a point at the end. */
    void
    add(const types::particle_index    id,
        const Point<dim>              &position,
        const ArrayView<const double> &values)
    {
      ids.push_back(id);
      positions.push_back(position);
      properties.insert(properties.end(), values.begin(), values.end());
    }
  };
} // namespace Morula

#endif
