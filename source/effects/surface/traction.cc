// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/loads.h>
#include <morula/effects/surface/placed_condition.h>

namespace Morula
{
  namespace
  {
    /** The keys of the traction, in section "Boundary conditions". */
    struct TractionParameters : public ConditionKeys
    {
      TractionParameters()
        : ConditionKeys("Boundary conditions/Traction where",
                        "Expression of X, Y, Z: traction acts where it is > 0; "
                        "empty: nowhere.")
      {}

      ExpressionKey traction{
        {this, "Boundary conditions/Traction"},
        "0; 0; 0",
        "Traction per initial area (dead load): functions of "
        "X, Y, Z, t separated by ';'. Units: kPa.",
        Evaluated::place,
        3};
      void
      check(const SceneKeys &scene, Review &) const override
      {
        if (is_on() && scene.tissue.surface == "from cells")
          scene.tissue.surface.refuse(
            "tracked, as " + where.path() + " is set",
            "A traction is a force per area of t = 0, which is not known on "
            "a surface that is made anew.");
      }
    };

    /** Dead traction: doc/theory.md (4.7). */
    template <int dim>
    class Traction : public PlacedCondition<dim>
    {
    public:
      using Parameters = TractionParameters;

      /** @throws InputError for expressions that cannot be parsed */
      explicit Traction(const Parameters &parameters)
        : PlacedCondition<dim>(SurfaceCondition::loaded,
                               parameters,
                               parameters.traction,
                               dim)
      {}

      std::unique_ptr<Term<dim>>
      term(const LoadedPoints<dim> &points, const double t) const override
      {
        return std::make_unique<DeadLoad<dim>>(
          points,
          // The area is the initial one: a dead load.
          this->template loads<Tensor<1, dim>>(points, [&](const auto &point) {
            return point.initial_area * this->prescribed->vector(point.X, t);
          }));
      }
    };
  } // namespace


  void
  add_traction(Catalogue &catalogue)
  {
    catalogue.add_own<Traction>("traction",
                                {"Boundary conditions/Fixed where=X + Y < -2",
                                 "Boundary conditions/Traction where=X + Y > 2",
                                 "Boundary conditions/Traction=0.1; 0.1; 0.1"});
  }
} // namespace Morula
