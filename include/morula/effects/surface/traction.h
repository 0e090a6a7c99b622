// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_traction_h
#define morula_effects_surface_traction_h

#include <morula/effects/surface/placed_condition.h>

namespace Morula
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
    std::string
    details() const override;
  };

  /** Dead traction: doc/theory.md (4.7). */
  template <int dim>
  class Traction : public PlacedCondition<dim>
  {
  public:
    using Parameters = TractionParameters;

    /** @throws InputError for expressions that cannot be parsed */
    explicit Traction(const Parameters &parameters);

    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;

  private:
    void
    check_at(const Point<dim> &X, const double t) const override;

    const Expression traction;
  };
} // namespace Morula

#endif
