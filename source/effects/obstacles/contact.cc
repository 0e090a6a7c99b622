// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/obstacles/contact.h>

#include <utility>

namespace Morula
{
  template <int dim>
  Contact<dim>::Contact(GroupedPoints<dim>         points,
                        std::vector<BoundaryPoint> boundary_points,
                        std::vector<Obstacle>      obstacles)
    : PointTerm<dim>(std::move(points))
    , boundary_points(std::move(boundary_points))
    , obstacles(std::move(obstacles))
  {}


  template <int dim>
  void
  Contact<dim>::add_point(const unsigned int       p,
                          const SplineValues<dim> &splines,
                          const LocalField<dim>   &field,
                          LocalSystem<dim>        &system) const
  {
    const Point<dim> x = boundary_points[p].x + field.value(splines);
    for (const Obstacle &obstacle : obstacles)
      {
        const Distance<dim> phi = obstacle.body->distance(x - obstacle.way);
        if (obstacle.is_mould ? phi.value <= 0. : phi.value >= 0.)
          continue;
        const double k = boundary_points[p].area * obstacle.stiffness;
        add_force_at(splines,
                     0.5 * k * phi.value * phi.value,
                     k * phi.value * phi.gradient,
                     k * (outer_product(phi.gradient, phi.gradient) +
                          phi.value * phi.curvature),
                     system);
      }
  }


  template class Contact<2>;
  template class Contact<3>;
} // namespace Morula
