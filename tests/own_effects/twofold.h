// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A material: neo-Hookean, with some times the stiffness that E and ν give.

#ifndef own_effects_twofold_h
#define own_effects_twofold_h

#include <morula/mechanics/materials/laws.h>

namespace Own
{
  using namespace Morula;

  struct Twofold
  {
    double factor = 2.;

    template <typename Number>
    Response<Number>
    response(const Strain<Number> &strain) const
    {
      Strain<Number> stiffer = strain;
      stiffer.lambda         = factor * strain.lambda;
      stiffer.mu             = factor * strain.mu;
      return NeoHookean().response(stiffer);
    }
  };
} // namespace Own

#endif
