// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/time_steps.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Morula
{
  TimeSteps::TimeSteps(const TimeParameters &parameters)
    : parameters(parameters)
    , state_({0., parameters.step, 0, 0., 0, 0, 0., false})
  {
    begin_anew();
  }

  void
  TimeSteps::restore(const State &state)
  {
    // With the same Time/Step and no other end of the interval the sequence
    // goes on to the bit. Otherwise a new interval begins at the snapshot's
    // time and ends at the next multiple of the new Step.
    state_ = state;
    if (state.step == parameters.step && time() == state.time)
      return;
    const double n_steps =
      std::floor(state.time / parameters.step + time_slack);
    state_ = {state.time,
              parameters.step,
              static_cast<unsigned int>(n_steps),
              state.time,
              0,
              0,
              state.past,
              state.anew};
  }

  double
  TimeSteps::end_of_interval() const
  {
    // A last step within rounding of End time would be too short to solve.
    const double end = (state_.interval + 1) * parameters.step;
    return end > parameters.end_time - time_slack * parameters.step ?
             parameters.end_time :
             end;
  }

  double
  TimeSteps::at(const unsigned int part) const
  {
    // Times are multiples of a part and no sums of steps. The end of the
    // interval is taken as it is, so that intervals fit together to the bit.
    const unsigned int parts = 1u << state_.level;
    return part == parts ?
             end_of_interval() :
             state_.begin + part * ((end_of_interval() - state_.begin) / parts);
  }

  void
  TimeSteps::halve()
  {
    // The time stays: twice as many parts of half the length are done.
    state_.part *= 2;
    ++state_.level;
  }

  void
  TimeSteps::adapt(const double mu)
  {
    // This is doc/theory.md (5.11). What the last step missed goes with the
    // square of its length, which tells what the next one would miss. A longer
    // step is tried first, and by one level only; it must begin at a multiple
    // of its own length, so that steps do not cross the intervals' ends. The
    // first step and that after a cut are not made longer.
    if (parameters.tolerance <= 0.)
      return;
    const bool anew = std::exchange(state_.anew, false);
    // Only a doubled step that stays well below the tolerance is worth it.
    // Without this margin lengths would swing: a step would be doubled, and
    // halved again.
    const double     ratio      = next() - time() > 0. && past().exists() ?
                                    past().length() / (next() - time()) :
                                    1.;
    constexpr double hysteresis = 2.; // this is √2 in the length
    double           error      = mu / (ratio * ratio);
    if (!anew && state_.level > 0 && state_.part % 2 == 0 &&
        4. * hysteresis * error <= parameters.tolerance)
      {
        state_.part /= 2;
        --state_.level;
        return;
      }
    for (; error > parameters.tolerance && can_halve(); error /= 4.)
      halve();
  }

  void
  TimeSteps::begin_anew()
  {
    // Nothing is known yet of what the next step will miss, so that it is
    // short: Step/16, doc/theory.md, section 5.11. Longer ones follow by a
    // factor of two a step.
    constexpr unsigned int first_level = 4;
    if (parameters.tolerance <= 0.)
      return;
    state_.anew = true;
    while (state_.level < first_level && can_halve())
      halve();
  }

  void
  TimeSteps::accept(const bool is_slow)
  {
    // Three things can follow a step. Its interval is done: the next one
    // begins, with steps as long as before if Tolerance chooses them, else with
    // Step. Or two halves are done, and the next step is twice as long again.
    // Or the next step is as long as this one. With Tolerance adapt() decides,
    // and not this function. Slow steps stay short.
    state_.past = time();
    ++state_.part;
    if (state_.part == 1u << state_.level)
      {
        // An interval that End time has cut is not finished: a resumed run with
        // a later End time may go on in it.
        const double end = end_of_interval();
        if (end >= (state_.interval + 1 - time_slack) * parameters.step)
          ++state_.interval;
        state_.begin = end;
        state_.part  = 0;
        if (parameters.tolerance <= 0. && !is_slow)
          state_.level = 0;
      }
    else if (parameters.tolerance <= 0. && !is_slow && state_.level > 0 &&
             state_.part % 2 == 0)
      {
        state_.part /= 2;
        --state_.level;
      }
    state_.time = time();
  }

  bool
  TimeSteps::can_halve() const
  {
    // Below level 30 the number of parts of an interval fits in an unsigned
    // int.
    return 0.5 * (next() - time()) >=
             parameters.smallest_step * (1. - time_slack) &&
           state_.level < 30;
  }

  bool
  TimeSteps::reject()
  {
    if (!can_halve())
      return false;
    halve();
    return true;
  }
} // namespace Morula
