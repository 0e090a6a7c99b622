// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/body_force.h>

namespace Morula
{
  void
  BodyForceParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Force density",
                      force_density,
                      "Force per initial volume: functions of X, Y, Z, t "
                      "separated by ';'. Units: kPa/um.");
  }
} // namespace Morula
