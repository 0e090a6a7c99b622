// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_carriers_h
#define morula_effects_surface_carriers_h

#include <morula/particles/nearest.h>
#include <morula/particles/tissue.h>

#include <type_traits>
#include <vector>

namespace Morula
{
  // A held point belongs to a cell, its carrier, whose growth it takes:
  // doc/theory.md, section 4.2. Were it the nearest cell of each step, the
  // traction of the point would jump whenever another cell comes nearer.

  /** The held points of this rank by active grid cell. */
  template <int dim>
  PointGroups
  held_groups(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
  {
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    return group_points(store, space, [&](const unsigned int p) {
      return is_held(store.condition(p));
    });
  }

  /** The directions in which a fixed or slip point is held, M. */
  template <int dim>
  Tensor<2, dim>
  projection(const BoundaryView<dim> &point)
  {
    if (point.condition() == SurfaceCondition::slip)
      return outer_product(point.initial_normal(), point.initial_normal());
    return Tensor<2, dim>(unit_symmetric_tensor<dim>());
  }

  /** Adds the column of the carriers. */
  template <int dim>
  void
  add_carriers(BoundaryColumns<dim> &columns);

  /**
   * Gives held points the nearest cell as their carrier, if they have none yet,
   * or if theirs has divided, has died, or is more than two grid cells away. A
   * point with several equally near cells gets none. Does nothing without the
   * column. Collective.
   */
  template <int dim>
  void
  renew_carriers(Tissue<dim> &tissue);

  /** Ids of the points' carriers. */
  template <int dim>
  std::vector<types::particle_index>
  carriers(const std::vector<unsigned int> &points, const Tissue<dim> &tissue);

  /**
   * The values value(p) of the carriers of some boundary points, from those of
   * this rank's cells p; where a point has none, that of the nearest cell, or
   * the mean of several equally near ones. Collective.
   * @param points by their positions in the tissue's store
   */
  template <int dim, typename Value>
  auto
  carrier_values(const std::vector<unsigned int> &points,
                 const Tissue<dim>               &tissue,
                 const Value                     &value)
  {
    const BoundaryPoints<dim>    &store  = tissue.boundary_points();
    const std::vector<Point<dim>> places = store.positions_of(points);
    auto                          found  = values_by_id(
      carriers(points, tissue), places, tissue.cells(), value, tissue.grid());

    std::vector<unsigned int> others;
    for (std::size_t k = 0; k < places.size(); ++k)
      if (!found[k])
        others.push_back(points[k]);
    const auto nearest = nearest_values(store.positions_of(others),
                                        tissue.cells(),
                                        value,
                                        Ties::mean,
                                        tissue.grid(),
                                        store.sides_of(others));
    std::vector<std::invoke_result_t<Value, unsigned int>> values;
    for (std::size_t k = 0, n = 0; k < places.size(); ++k)
      values.push_back(found[k] ? *found[k] : nearest[n++]);
    return values;
  }
} // namespace Morula

#endif
