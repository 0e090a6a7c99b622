// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/placed_condition.h>

namespace Morula
{
  template <int dim>
  PlacedCondition<dim>::PlacedCondition(const SurfaceCondition kind,
                                        const ConditionKeys   &keys)
    : kind_(kind)
    , where(keys.where.expression(dim))
  {}


  template <int dim>
  void
  PlacedCondition<dim>::check(const Preview<dim> &scene) const
  {
    // Each point on which the condition acts is tried at both ends of the run.
    for (const Point<dim> &X : scene.boundary_points)
      if (holds(X))
        for (const double t : {0., scene.keys.time.end_time.value()})
          check_at(X, t);
  }


  template <int dim>
  bool
  PlacedCondition<dim>::holds(const Point<dim> &X) const
  {
    // Conditions are decided at t = 0, for the whole run.
    return where.value(X, 0.) > 0.;
  }


  template class PlacedCondition<2>;
  template class PlacedCondition<3>;
} // namespace Morula
