// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_hazard_h
#define morula_effects_fate_hazard_h

#include <optional>

namespace Morula
{
  /**
   * The chance of an event, integrated: the event comes when the integral of
   * its rate reaches a threshold that is exponentially distributed with mean 1.
   * doc/theory.md (6.6), (6.7). The rate is constant from t0 on.
   */
  struct Hazard
  {
    double rate;      // 1/day, >= 0
    double integral;  // at t0
    double threshold; // of the integral

    /** When the event comes, if it does in (t0, t1]; day. */
    std::optional<double>
    event(const double t0, const double t1) const;

    /** The integral at @p t. */
    double
    integral_at(const double t0, const double t) const;
  };
} // namespace Morula

#endif
