// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_time_left_h
#define morula_output_time_left_h

#include <string>
#include <vector>

namespace Morula
{
  /**
   * Estimates how long a run still takes. Tissues grow, and a simulated day
   * costs more and more. So the wall time is extrapolated as a power
   * (t - t_0)^p of the simulated time; p follows from the wall times of the
   * first and the second half so far. Early in the run this is more sensible
   * than an exponential.
   */
  class TimeLeft
  {
  public:
    /** @param start, end simulated times at which this program begins and ends,
     *   day */
    TimeLeft(const double start, const double end);

    /** Records that the simulated time @p time was reached after so many wall
     *  seconds. */
    void
    add(const double time, const double wall_seconds);

    /** Wall seconds from the last record to the end; -1 if not known yet. */
    double
    seconds() const;

  private:
    struct Record
    {
      double time;
      double wall_seconds;
    };

    double              end;
    std::vector<Record> records;
  };

  /** A duration as text: `42 s`, `3 min 20 s`, `2 h 05 min`, `1 d 03 h`. */
  std::string
  duration(const double seconds);
} // namespace Morula

#endif
