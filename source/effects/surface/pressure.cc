// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/surface/loads.h>
#include <morula/effects/surface/placed_condition.h>

namespace Morula
{
  namespace
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
    };

    /** Pressure that follows the surface: doc/theory.md (4.8). */
    template <int dim>
    class Pressure : public PlacedCondition<dim>
    {
    public:
      using Parameters = PressureParameters;

      /** @throws InputError for expressions that cannot be parsed */
      explicit Pressure(const Parameters &parameters)
        : PlacedCondition<dim>(SurfaceCondition::loaded,
                               parameters,
                               parameters.pressure,
                               1)
      {}

      std::unique_ptr<Term<dim>>
      term(const LoadedPoints<dim> &points, const double t) const override
      {
        return following_pressure<dim>(
          // The value is that at the end of the step, at the point's own X;
          // whether it acts, its seed decides.
          points,
          this->template loads<AreaLoad<dim>>(points, [&](const auto &point) {
            return AreaLoad<dim>{this->prescribed->value(point.X, t),
                                 point.area};
          }));
      }
    };
  } // namespace


  void
  add_pressure(Catalogue &catalogue)
  {
    catalogue.add_own<Pressure>("pressure",
                                {"Boundary conditions/Fixed where=X + Y < -2",
                                 "Boundary conditions/Pressure where=X + Y > 2",
                                 "Boundary conditions/Pressure=0.1"});
  }
} // namespace Morula
