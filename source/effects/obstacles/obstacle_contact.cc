// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/obstacles/obstacle_contact.h>

#include <utility>

namespace Morula
{
  template <int dim>
  ObstacleContact<dim>::ObstacleContact(
    GroupedPoints<dim>         points,
    std::vector<BoundaryPoint> boundary_points,
    std::vector<Obstacle>      obstacles)
    : PointTerm<dim>(std::move(points))
    , boundary_points(std::move(boundary_points))
    , obstacles(std::move(obstacles))
  {}


  template <int dim>
  void
  ObstacleContact<dim>::add_point(const unsigned int       p,
                                  const SplineValues<dim> &splines,
                                  const LocalField<dim>   &field,
                                  LocalSystem<dim>        &system) const
  {
    // The place is the one of this evaluation, x_t + u, so Newton's method
    // finds anew which points touch. The body stays where it is at t = 0 and
    // the place goes back by the body's way, since a body only moves and never
    // turns.
    const Point<dim> x = boundary_points[p].x + field.value(splines);
    for (const Obstacle &obstacle : obstacles)
      {
        // For a mould, φ of doc/theory.md (4.8d) is minus the distance to the
        // body. Energy, force and tangent are all even in φ, so the sign
        // matters only to which points are in contact.
        const Distance<dim> phi = obstacle.body->distance(x - obstacle.way);
        if (obstacle.is_mould ? phi.value <= 0. : phi.value >= 0.)
          continue;
        const double k = boundary_points[p].area * obstacle.stiffness;
        // The energy is that of doc/theory.md (4.8d), the force its derivative,
        // and the matrix that of (4.8e), with a_t κ in k. Inside of a round
        // body the term with the curvature is negative along its surface, as a
        // point there may slide off it.
        add_force_at(splines,
                     0.5 * k * phi.value * phi.value,
                     k * phi.value * phi.gradient,
                     k * (outer_product(phi.gradient, phi.gradient) +
                          phi.value * phi.curvature),
                     system);
      }
  }


  template class ObstacleContact<2>;
  template class ObstacleContact<3>;
} // namespace Morula
