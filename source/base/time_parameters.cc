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


  TimeParameters::TimeParameters()
    : end_time("Time/End time",
               1.,
               "Time at which the run ends; > 0. Units: day.")
    , step(step_path,
           0.05,
           "Time step; > 0. Steps end at its multiples. Units: day.")
    , smallest_step("Time/Smallest step",
                    1e-4,
                    "A step that fails is halved; the run gives up below "
                    "this; > 0. Units: day.")
    , stop_at_cells("Time/Stop at cells",
                    0,
                    "End early at the first step end with at least so many "
                    "cells; 0: never.")
    , tolerance("Time/Tolerance",
                0.,
                "What a step may miss of growth and flow, as a share of the "
                "tissue's volume (step_error in statistics.csv): steps are "
                "Step/2^k, as long as this allows, and short at the start and "
                "after a cut. Not negative; 0: all steps are Step long.")
  {
    const auto is_positive = [](const double t) { return t > 0.; };
    end_time.require(is_positive,
                     "a number of days > 0",
                     "Choose a later end.");
    step.require(is_positive,
                 "a number of days > 0",
                 "Choose a positive step.");
    tolerance.require([](const double share) { return share >= 0.; },
                      "a number >= 0",
                      "0 keeps all steps as long as Step.");
  }


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
