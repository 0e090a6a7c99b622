// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_body_force_h
#define morula_effects_forces_body_force_h

#include <morula/base/expression.h>
#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /** Section "Body force". */
  struct BodyForceParameters : public EffectKeys
  {
    ExpressionKey force_density{
      {this, "Body force/Force density"},
      "0; 0; 0",
      "Force per initial volume: an expression for each "
      "direction, separated by ';'. Units: kPa/um.",
      Evaluated::step,
      3};

    bool
    is_on() const override
    {
      return force_density.is_changed();
    }
    std::string
    details() const override
    {
      return force_density.text() + " kPa/um";
    }
  };

  /**
   * Forces on particles that depend on where these are at the end of the step,
   * V⁰ b(x + u): doc/theory.md (4.7b). It has no energy. Its tangent
   * -V⁰ ∂b/∂x N_a N_b comes from differences of b.
   */
  template <int dim>
  class PlacedForce : public PointTerm<dim>
  {
  public:
    /** A particle. */
    struct Particle
    {
      /** Position at the beginning of the step, µm. */
      Point<dim> x;
      /** V⁰, µm^dim. */
      double volume;
      /** Of the other variables of b. */
      VariableValues values;
    };

    /** @param density b, kPa/µm; a reference is kept */
    PlacedForce(GroupedPoints<dim>    points,
                std::vector<Particle> particles,
                const Expression     &density);

    bool
    is_conservative() const override
    {
      return false;
    }

    /** Whether an expression depends on the present place. */
    static bool
    depends_on_place(const Expression &expression);

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    /** b of a particle at a place, kPa/µm. */
    Tensor<1, dim>
    density_at(const Particle &particle, const Point<dim> &x) const;

    const std::vector<Particle> particles;
    const Expression           &density;
  };
} // namespace Morula

#endif
