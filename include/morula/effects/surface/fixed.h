// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_fixed_h
#define morula_effects_surface_fixed_h

#include <morula/effects/surface/placed_condition.h>

namespace Morula
{
  /** The keys of fixed points, in section "Boundary conditions". */
  struct FixedParameters : public ConditionKeys
  {
    FixedParameters()
      : ConditionKeys("Boundary conditions/Fixed where",
                      "Expression of X, Y, Z (initial position on the surface, "
                      "um): points where it is > 0 are fixed, e.g. Z <= 0; "
                      "empty: nowhere. Fixed wins over slip.")
    {}

    ExpressionKey displacement{{this, "Boundary conditions/Displacement"},
                               "0; 0; 0",
                               "Displacement of the fixed points: functions of "
                               "X, Y, Z, t separated by ';'. Units: um.",
                               Evaluated::place,
                               3};
    EffectFacts
    facts() const override
    {
      EffectFacts facts = ConditionKeys::facts();
      facts.topic       = "fixed points (Nitsche)";
      return facts;
    }
  };
} // namespace Morula

#endif
