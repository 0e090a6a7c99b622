// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_time_left_h
#define morula_output_time_left_h

#include <string>
#include <vector>

namespace Morula
{
  /**
   * How long a run still takes. Tissues grow, and so does the cost of a
   * simulated day: the wall time is extrapolated as the power (t - t_0)^p of
   * the simulated time, with p from the first and the second half so far. In
   * contrast to an exponential, this stays sensible early in the run.
   */
  class TimeLeft
  {
  public:
    /** @param start, end simulated time at which this program began and ends,
     *   day */
    TimeLeft(const double start, const double end);

    /** Records that the simulated time @p time was reached after so long. */
    void
    add(const double time, const double wall_seconds);

    /** Wall seconds from the last record to the end; -1: not known yet. */
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

  /** A duration for people: `42 s`, `3 min 20 s`, `2 h 05 min`, `1 d 03 h`. */
  std::string
  duration(const double seconds);
} // namespace Morula

#endif
