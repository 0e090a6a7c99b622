// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_division_parameters_h
#define morula_effects_division_division_parameters_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>

#include <string>

namespace Morula
{
  /** The keys of section "Proliferation/Cell cycle" that say along what cells
   *  divide, and where daughters are placed: with a cycle and without. */
  struct DivisionParameters : public EffectKeys
  {
    DivisionParameters();

    Key<std::string> axis;
    ExpressionKey    axis_spread; // κ
    ExpressionKey    least_anisotropy;
    Key<bool>        axis_follows_rotation;
    Key<bool>        stay_inside;


    using Keys::list;
    KeyList
    list() override;
  };
} // namespace Morula

#endif
