// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_past_step_h
#define morula_base_past_step_h

namespace Morula
{
  /** The step that led to a state: what it expected of its end is compared with
   *  the state, doc/theory.md (5.9). */
  struct PastStep
  {
    /** Day; equal if there was no step yet. */
    double begin = 0., end = 0.;

    /** Whether there was a step. */
    bool
    exists() const
    {
      return end > begin;
    }

    /** Day. */
    double
    length() const
    {
      return end - begin;
    }

    /** The middle of the step, day: the time for which rates are evaluated. */
    double
    middle() const
    {
      return 0.5 * (begin + end);
    }
  };
} // namespace Morula

#endif
