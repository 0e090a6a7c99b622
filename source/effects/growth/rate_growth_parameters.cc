// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/scene_keys.h>

namespace Morula
{
  RateGrowthParameters::RateGrowthParameters()
  {
    // The rate itself may be negative, as cells may wither; a negative
    // coefficient of homeostasis would drive the stress away from its target
    // and is refused. Expressions are evaluated once in each step.
    rate.symbol("k");
    homeostatic_stress.needs({homeostasis.path()});
    share_along.needs({direction.path()});
    direction.needs({share_along.path()});
  }
} // namespace Morula
