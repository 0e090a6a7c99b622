// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_surface_tension_h
#define morula_effects_surface_surface_tension_h

#include <morula/effects/surface/placed_condition.h>

namespace Morula
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
    is_on() const override;
    void
    check(const SceneKeys &scene, Review &review) const override;
    std::string
    details() const override;
  };

  /** Tension of the surface, which squeezes a ball by Laplace's pressure:
   *  doc/theory.md (4.8a), (4.8c). */
  template <int dim>
  class SurfaceTension : public PlacedCondition<dim>
  {
  public:
    using Parameters = SurfaceTensionParameters;

    /** @throws InputError for expressions that cannot be parsed */
    explicit SurfaceTension(const Parameters &parameters);

    bool
    is_tension() const override
    {
      return true;
    }

    /** @throws InputError if the tension has no value or is negative */
    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;

  private:
    void
    check_at(const Point<dim> &X, const double t) const override;

    const Expression tension;
  };
} // namespace Morula

#endif
