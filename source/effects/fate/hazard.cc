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
    if (!(rate > 0. && left <= rate * (t1 - t0)))
      return {};
    return t0 + std::max(0., left) / rate;
  }


  double
  Hazard::integral_at(const double t0, const double t) const
  {
    return integral + rate * (t - t0);
  }
} // namespace Morula
