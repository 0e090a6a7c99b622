// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/time_parameters.h>

namespace Morula
{
  namespace
  {
    /** Steps are counted by integers. */
    constexpr double max_steps = 1e9;
  } // namespace


  void
  TimeParameters::check() const
  {
    // The keys are checked by themselves first; then against each other.
    end_time.check(0);
    step.check(0);
    tolerance.check(0);
    // Numbers of steps are integers, also in snapshots.
    if (!(end_time <= max_steps * step))
      step.refuse("at least " + end_time.path() + " = " + as_text(end_time) +
                    " day / " + as_text(max_steps),
                  "Raise it, or choose an earlier end.");
    if (!(smallest_step > 0. && smallest_step <= step))
      smallest_step.refuse("a number of days > 0 and <= Time/Step = " +
                             as_text(step) + " day",
                           "Lower it, or raise " + step.path() + ".");
  }
} // namespace Morula
