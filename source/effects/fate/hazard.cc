// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/hazard.h>

#include <algorithm>

namespace Morula
{
  std::optional<double>
  Hazard::event(const double t0, const double t1) const
  {
    const double left = threshold - integral;
    if (left <= 0.)
      return t0;
    if (!(rate > 0. && left <= rate * (t1 - t0)))
      return {};
    return t0 + left / rate;
  }


  double
  Hazard::integral_at(const double t0, const double t) const
  {
    return integral + rate * (t - t0);
  }


  double
  with_missed(const double integral,
              const double rate,
              const double expected,
              const double dt)
  {
    return expected >= 0. ?
             std::max(0., integral + 0.5 * dt * (rate - expected)) :
             integral;
  }
} // namespace Morula
