// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_time_parameters_h
#define morula_base_time_parameters_h

#include <morula/base/key.h>

namespace Morula
{
  /** Times closer than this fraction of a step count as equal. */
  constexpr double time_slack = 1e-9;

  /** Section "Time". */
  struct TimeParameters : public Keys
  {
    TimeParameters();

    Key<double>       end_time;      // day
    Key<double>       step;          // day
    Key<double>       smallest_step; // day
    Key<unsigned int> stop_at_cells;
    Key<double>       tolerance;

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
    check() const;

    using Keys::list;
    KeyList
    list() override
    {
      return {&end_time, &step, &smallest_step, &stop_at_cells, &tolerance};
    }
  };
} // namespace Morula

#endif
