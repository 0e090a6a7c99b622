// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_pressure_h
#define morula_effects_surface_pressure_h

#include <morula/effects/surface/placed_condition.h>

namespace Morula
{
  /** The keys of the pressure, in section "Boundary conditions". */
  struct PressureParameters : public ConditionKeys
  {
    PressureParameters()
      : ConditionKeys("Boundary conditions/Pressure where",
                      "Expression of X, Y, Z: pressure acts where it is > 0; "
                      "empty: nowhere.")
    {}

    ExpressionKey pressure{{this, "Boundary conditions/Pressure"},
                           "0",
                           "Pressure that follows the surface, a function of "
                           "X, Y, Z, t; positive pushes inward. Units: kPa.",
                           Evaluated::place};
    std::string
    details() const override;
  };

  /** Pressure that follows the surface: doc/theory.md (4.8). */
  template <int dim>
  class Pressure : public PlacedCondition<dim>
  {
  public:
    using Parameters = PressureParameters;

    /** @throws InputError for expressions that cannot be parsed */
    explicit Pressure(const Parameters &parameters);

    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;

  private:
    void
    check_at(const Point<dim> &X, const double t) const override;

    const Expression pressure;
  };
} // namespace Morula

#endif
