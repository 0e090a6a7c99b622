// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_terms_h
#define morula_effects_surface_boundary_terms_h

#include <morula/effects/development.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>
#include <morula/particles/nearest.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <string>
#include <tuple>
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

  /** F_g at t and t + dt, and λ and μ. */
  template <int dim>
  using CellState = std::tuple<Tensor<2, dim>, Tensor<2, dim>, double, double>;

  /** The held points of this rank, as far as they are the same for all forms:
   *  without their penalty. */
  template <int dim>
  struct HeldPoints
  {
    PointGroups                                   groups;
    std::vector<typename Nitsche<dim>::HeldPoint> list;
    std::vector<double>                           youngs_moduli; // kPa
    /** Empty if cells neither grow nor have a stiffness by their state. */
    std::vector<CellState<dim>> carriers;
  };

  /** Collective; @p t is the end of the step, day. */
  template <int dim>
  HeldPoints<dim>
  points_of_term(const BoundaryConditions<dim> &conditions,
                 const TissueMaterial          &material,
                 const Tissue<dim>             &tissue,
                 const SplineSpace<dim>        &space,
                 const DevelopmentOfStep<dim>  &growth,
                 const double                   t);

  /**
   * Nitsche's term for the fixed and slip points, over the step up to time
   * @p t. Collective.
   * @param kernel value of Solver/Kernel
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  nitsche_term(const BoundaryConditions<dim> &conditions,
               const TissueMaterial          &material,
               const Tissue<dim>             &tissue,
               const SplineSpace<dim>        &space,
               const DevelopmentOfStep<dim>  &growth,
               const double                   t,
               const std::string             &kernel);

  /**
   * The bounded form in an attempt at a step: its term, and the traction of
   * this rank's held points, which is zero until it begins and renewed in
   * turns: doc/theory.md (4.6a). Keeps references to all that it is given.
   * Collective.
   */
  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  held_traction(const BoundaryConditions<dim> &conditions,
                const AttemptAtStep<dim>      &attempt);

  /** The boundary points of this rank that conditions load. */
  template <int dim>
  LoadedPoints<dim>
  loaded_points(const Tissue<dim> &tissue, const SplineSpace<dim> &space);

  /** The fixed and slip points of this rank. */
  template <int dim>
  std::vector<typename RigidModes<dim>::Support>
  supports(const BoundaryConditions<dim> &conditions,
           const Tissue<dim>             &tissue,
           const SplineSpace<dim>        &space);

  /** Where the fixed and slip points of this rank are held at @p t and at
   *  @p t_next; at the start of the run (@p t = 0) nothing has moved yet, even
   *  if the prescribed displacement is not 0. */
  template <int dim>
  std::vector<HeldPoint<dim>>
  held_points(const BoundaryConditions<dim> &conditions,
              const Tissue<dim>             &tissue,
              const double                   t,
              const double                   t_next);
} // namespace Morula

#endif
