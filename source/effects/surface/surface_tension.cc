// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/loads.h>
#include <morula/effects/surface/placed_condition.h>

namespace Morula
{
  namespace
  {
    /** The keys of the surface tension, in section "Boundary conditions". */
    struct SurfaceTensionParameters : public ConditionKeys
    {
      SurfaceTensionParameters()
        : ConditionKeys(
            "Boundary conditions/Surface tension where",
            "Expression of X, Y, Z: the surface has the tension where "
            "it is > 0; 1: everywhere.",
            "1")
      {
        where.needs({tension.path()});
      }

      ExpressionKey tension{
        {this, "Boundary conditions/Surface tension"},
        "0",
        "Tension of the surface, a function of X, Y, Z, t; not negative. "
        "0: none. 1 kPa um = 1 mN/m. Units: kPa um.",
        Evaluated::place,
        not_negative("kPa um",
                     "A surface with a negative tension would crumple.")};

      bool
      is_on() const override
      {
        // The place has a default, everywhere. So the tension itself says
        // whether there is one.
        return !where.empty() && !tension.is_default();
      }
      void
      check(const SceneKeys &scene, Review &) const override
      {
        if (scene.catalogue.tensions().any_with_surface() &&
            !tension.is_default())
          tension.refuse(
            "its default, as types of cells have tensions with the surface",
            "Remove this key, or each type's Tension/With surface.");
      }
    };

    /** Tension of the surface, which squeezes a ball by Laplace's pressure:
     *  doc/theory.md (4.8a), (4.8c). */
    template <int dim>
    class SurfaceTension : public PlacedCondition<dim>
    {
    public:
      using Parameters = SurfaceTensionParameters;

      /** @throws InputError for expressions that cannot be parsed */
      explicit SurfaceTension(const Parameters &parameters)
        : PlacedCondition<dim>(SurfaceCondition::loaded,
                               parameters,
                               parameters.tension,
                               1)
      {}


      /** @throws InputError if the tension has no value or is negative */
      std::unique_ptr<Term<dim>>
      term(const LoadedPoints<dim> &points, const double t) const override
      {
        return surface_energy<dim>(
          points,
          this->template loads<AreaLoad<dim>>(points, [&](const auto &point) {
            return AreaLoad<dim>{this->prescribed->value(point.X, t),
                                 point.area};
          }));
      }
    };
  } // namespace


  void
  add_surface_tension(Catalogue &catalogue)
  {
    catalogue.add_own<SurfaceTension>(
      "surface tension", {"Boundary conditions/Surface tension=0.1"});
  }
} // namespace Morula
