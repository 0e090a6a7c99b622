// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/placed_condition.h>

#include <cmath>
#include <optional>

namespace Morula
{
  namespace
  {
    /** The keys of slip points, in section "Boundary conditions". */
    struct SlipParameters : public ConditionKeys
    {
      SlipParameters()
        : ConditionKeys(
            "Boundary conditions/Slip where",
            "Expression of X, Y, Z: the displacement along the normal is zero "
            "where it is > 0; empty: nowhere. Slip wins over traction.")
      {}

      DirectionKey normal{
        {this, "Boundary conditions/Slip normal"},
        "",
        "Direction, e.g. 0, 0, 1: only points whose initial normal N is along "
        "it, |N.normal| > 0.9, slip; empty: all, each along its own normal."};
      EffectFacts
      facts() const override
      {
        EffectFacts facts = ConditionKeys::facts();
        facts.topic       = "slip (Nitsche)";
        return facts;
      }

      /** Warns of tissue that passes through: what it holds leaves with it. */
      void
      check(const SceneKeys &scene, Review &review) const override
      {
        bool flows = scene.flows(), loses = false;
        for (const EffectKeys *const keys : scene.keys_in_use())
          {
            flows = flows || keys->facts().releases_shear;
            loses = loses || keys->loses_cells();
          }
        if (is_on() && scene.has_active_tissue() && flows && loses)
          review.warn(
            where.path(),
            where.text(),
            "it acts on the boundary points that are there at t = 0, "
            "not on the place. Where tissue grows, flows and is lost, "
            "these points move past the end of the wall, and those "
            "that follow are free.",
            "Put planes there (Obstacles/Names), with Two-sided = "
            "true where tissue must not leave them.");
      }
    };

    /** Points that are held along their own initial normal. */
    template <int dim>
    class Slip : public PlacedCondition<dim>
    {
    public:
      using Parameters = SlipParameters;

      /** @throws InputError for an expression or a direction that cannot be
       *  parsed */
      explicit Slip(const Parameters &parameters)
        : PlacedCondition<dim>(SurfaceCondition::slip, parameters)
      {
        if (!parameters.normal->empty())
          normal =
            unit_vector<dim>(parameters.normal.path(), parameters.normal);
      }

      bool
      acts_on(const Point<dim> &X, const Tensor<1, dim> &N) const override
      {
        // 0.9 is the cosine of 26 degrees: points of one flat side have the
        // same normal, those of its neighbours another.
        return PlacedCondition<dim>::acts_on(X, N) &&
               (!normal || std::abs(N * *normal) > 0.9);
      }

    private:
      std::optional<Tensor<1, dim>> normal; // of the points that slip
    };
  } // namespace


  void
  add_slip(Catalogue &catalogue)
  {
    catalogue.add_own<Slip>("slip",
                            {"Growth/Law=isotropic",
                             "Growth/Isotropic/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)",
                             "Boundary conditions/Slip where=X + Y < -2",
                             "Friction/Coefficient=0.1"});
  }
} // namespace Morula
