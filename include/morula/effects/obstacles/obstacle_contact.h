// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_obstacles_obstacle_contact_h
#define morula_effects_obstacles_obstacle_contact_h

#include <morula/effects/obstacles/body.h>
#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /**
   * Contact without friction between boundary points and rigid bodies: the
   * energy Π = Σ a_t κ φ²/2 of all points with φ < 0, where φ is the distance
   * to a body, positive on the side of the tissue. Its residual is
   * a_t κ φ ∇φ N_a, its tangent a_t κ (∇φ⊗∇φ + φ ∇∇φ) N_a N_b:
   * doc/theory.md (4.8d), (4.8e). Keeps references to the bodies.
   */
  template <int dim>
  class ObstacleContact : public PointTerm<dim>
  {
  public:
    /** A boundary point. */
    struct BoundaryPoint
    {
      /** Position at t, µm. */
      Point<dim> x;
      /** a_t, µm^(dim-1). */
      double area;
    };

    /** A body during the step. */
    struct Obstacle
    {
      /** The body at t = 0. */
      const Body<dim> *body;
      /** Whether the tissue is inside. */
      bool is_mould;
      /** Way of the body from t = 0 to the end of the step, µm. */
      Tensor<1, dim> way;
      /** κ, kPa/µm. */
      double stiffness;

      /** How deep @p x (µm) is in the obstacle, µm; negative: not in it. */
      double
      depth(const Point<dim> &x) const
      {
        const double distance = body->distance(x - way).value;
        return is_mould ? distance : -distance;
      }
    };

    ObstacleContact(GroupedPoints<dim>         points,
                    std::vector<BoundaryPoint> boundary_points,
                    std::vector<Obstacle>      obstacles);

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<BoundaryPoint> boundary_points;
    const std::vector<Obstacle>      obstacles;
  };
} // namespace Morula

#endif
