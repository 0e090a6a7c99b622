// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_obstacles_contact_h
#define morula_effects_obstacles_contact_h

#include <morula/effects/obstacles/body.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

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
  class Contact : public Term<dim>
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

    Contact(GroupedPoints<dim>         points,
            std::vector<BoundaryPoint> boundary_points,
            std::vector<Obstacle>      obstacles);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    const GroupedPoints<dim>         points;
    const std::vector<BoundaryPoint> boundary_points;
    const std::vector<Obstacle>      obstacles;
  };

  /**
   * What resists the displacement of cells in a step, energy Σ η V⁰ |u|²/2: so
   * weak that it does not count, but it decides where a piece of tissue goes
   * that nothing holds but obstacles, which only push: doc/theory.md (4.8f).
   */
  template <int dim>
  class Drag : public Term<dim>
  {
  public:
    /** η h²/E where E is that of the stiffest cell. */
    static constexpr double relative = 1e-4;

    /**
     * @param volumes V⁰ of each cell, µm^dim
     * @param eta     η, kPa/µm²
     */
    Drag(GroupedPoints<dim>  cells,
         std::vector<double> volumes,
         const double        eta);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    const GroupedPoints<dim>  cells;
    const std::vector<double> volumes;
    const double              eta;
  };
} // namespace Morula

#endif
