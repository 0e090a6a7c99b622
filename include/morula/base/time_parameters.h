// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_time_parameters_h
#define morula_base_time_parameters_h

#include <morula/base/key.h>

namespace Morula
{
  /** Times closer than this fraction of a step count as equal. */
  constexpr double time_slack = 1e-9;

  /** Most steps: they are counted by integers. */
  constexpr double max_steps = 1e9;

  /** Section "Time". */
  struct TimeParameters : public Keys
  {
    Key<double> end_time{{this, "Time/End time"},
                         1.,
                         "Time at which the run ends; > 0. Units: day.",
                         {},
                         positive("day", "Choose a later end.")};

    Key<double> step{{this, step_path},
                     0.05,
                     "Time step; > 0. Steps end at its multiples. Units: day.",
                     {},
                     positive("day", "Choose a positive step.")};

    Key<double> smallest_step{
      {this, "Time/Smallest step"},
      1e-4,
      "A step that fails is halved; the run gives up below "
      "this; > 0. Units: day."};

    Key<unsigned int> stop_at_cells{
      {this, "Time/Stop at cells"},
      0,
      "End early at the first step end with at least so many "
      "cells; 0: never."};

    Key<double> tolerance{
      {this, "Time/Tolerance"},
      0.,
      "Largest error of growth and flow in a step, relative to the tissue's "
      "volume. Steps are Step/2^k, as long as this allows, and short at the "
      "start and after a cut. Not negative; 0: all steps have the length "
      "Step.",
      {},
      not_negative("(a share)", "0 keeps all steps as long as Step.")};

    /** Path of the key that sets the step, for effects that refuse it. */
    static inline const std::string step_path = "Time/Step";

    /** Times closer than this count as equal, day. */
    double
    slack() const
    {
      return time_slack * step;
    }

    /** Checks each key, and refuses times that contradict each other. @throws
     *  InputError */
    void
    check() const
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
  };
} // namespace Morula

#endif
