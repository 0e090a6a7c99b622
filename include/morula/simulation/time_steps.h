// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_time_steps_h
#define morula_simulation_time_steps_h

#include <morula/scene/scene.h>

namespace Morula
{
  /**
   * The time steps. They end at k Step, the last is cut to End time; a rejected
   * step is subdivided inside its interval, by halves, and coarsened again
   * where the halves allow it. Times are multiples, never sums, so that they do
   * not drift.
   */
  class TimeSteps
  {
  public:
    explicit TimeSteps(const TimeParameters &parameters);

    /** Where in the sequence the run stands; numbers for a snapshot. */
    struct State
    {
      double       time;     // present time, day
      double       step;     // Step, day
      unsigned int interval; // the interval ends at (interval + 1) Step
      double       begin;    // of the interval, day
      unsigned int part;     // steps of this level done in the interval
      unsigned int level;    // the interval is cut into 2^level steps
    };

    State
    state() const;

    /** Continues from @p state, also if Step or End time have changed. */
    void
    restore(const State &state);

    /** Present time, day. */
    double
    time() const;

    /** End of the step to be tried, day. */
    double
    next() const;

    bool
    finished() const;

    /** The step has been done. */
    void
    accept();

    /**
     * The step has failed: the next is half as long.
     * @return whether that is still at least Smallest step
     */
    bool
    reject();

  private:
    double
    end_of_interval() const;

    double
    at(const unsigned int part) const;

    TimeParameters parameters;
    State          state_;
  };
} // namespace Morula

#endif
