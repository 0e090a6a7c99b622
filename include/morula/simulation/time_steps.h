// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_time_steps_h
#define morula_simulation_time_steps_h

#include <morula/base/past_step.h>
#include <morula/base/time_parameters.h>

namespace Morula
{
  /**
   * The time steps. Each step ends at a multiple of Step; the last one ends at
   * End time. A rejected step is halved inside its interval. After two halves
   * the next step is twice as long again. With Tolerance steps are Step/2^k, as
   * long as adapt() finds: doc/theory.md, section 5.11. Times are computed as
   * multiples and never as sums, so that they do not drift.
   */
  class TimeSteps
  {
  public:
    explicit TimeSteps(const TimeParameters &parameters);

    /** The place of the run in the sequence of steps, for a snapshot. */
    struct State
    {
      double       time;         // present time, day
      double       step;         // Step, day
      unsigned int interval;     // the interval ends at (interval + 1) Step
      double       begin;        // of the interval, day
      unsigned int part;         // steps of this level that are done
      unsigned int level;        // the interval is cut into 2^level steps
      double       past = 0.;    // when the last step began, day
      bool         anew = false; // the next step does not follow that one
    };

    State
    state() const
    {
      return state_;
    }

    /** Continues from @p state. Step and End time may have changed. */
    void
    restore(const State &state);

    /** Present time, day. */
    double
    time() const
    {
      return at(state_.part);
    }

    /** The step that led to the present state. */
    PastStep
    past() const
    {
      return {state_.past, time()};
    }

    /** End of the next step, day. */
    double
    next() const
    {
      return at(state_.part + 1);
    }

    /** Makes the next step as long as the error @p mu of the last one allows,
     *  doc/theory.md (5.11): shorter at once, longer by a factor 2 at most.
     * Does nothing without Tolerance. */
    void
    adapt(const double mu);

    /** Makes the next step short, as after a cut. Does nothing without
     *  Tolerance. */
    void
    begin_anew();

    bool
    finished() const
    {
      return time() >= parameters.end_time - time_slack * parameters.step;
    }

    /** Records that the step has succeeded. @param is_slow whether the next one
     *  shall be no longer */
    void
    accept(const bool is_slow = false);

    /** Whether half the next step is at least Smallest step. */
    bool
    can_halve() const;

    /**
     * Records that the step has failed. The next one is half as long.
     * @return whether the next step is at least Smallest step
     */
    bool
    reject();

  private:
    double
    end_of_interval() const;

    double
    at(const unsigned int part) const;

    /** Cuts the next step in two. The present time stays as it is. */
    void
    halve();

    TimeParameters parameters;
    State          state_;
  };
} // namespace Morula

#endif
