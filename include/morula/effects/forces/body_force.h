// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_body_force_h
#define morula_effects_forces_body_force_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>

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
  };
} // namespace Morula

#endif
