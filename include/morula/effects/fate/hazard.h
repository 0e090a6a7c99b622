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

    /** When the event comes, if it does in [t0, t1]; day. It comes at t0 if the
     *  integral has reached the threshold. */
    std::optional<double>
    event(const double t0, const double t1) const;

    /** The integral at @p t. */
    double
    integral_at(const double t0, const double t) const
    {
      return integral + rate * (t - t0);
    }
  };

  /** The rate that a step expects at its end where there is nothing to compare,
   *  as after a birth or a change of type. */
  constexpr double not_expected = -1.;

  /**
   * The integral of a rate that follows the state, with what the last step
   * missed of it: doc/theory.md (5.9). Not negative.
   * @param rate     for the last step's middle, in the present state
   * @param expected the same in the state before; or not_expected
   * @param dt       the last step's length, day
   */
  double
  with_missed(const double integral,
              const double rate,
              const double expected,
              const double dt);
} // namespace Morula

#endif
