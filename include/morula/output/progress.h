// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_progress_h
#define morula_output_progress_h

#include <morula/output/output_file.h>
#include <morula/output/rows.h>

#include <deal.II/base/timer.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

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
    TimeLeft(const double start, const double end)
      : end(end)
      , records({{start, 0.}})
    {}

    /** Records that the simulated time @p time was reached after so many wall
     *  seconds. What passes before the first step counts as no step's. */
    void
    add(const double time, const double wall_seconds)
    {
      if (time == records.front().first)
        records.clear();
      records.push_back({time, wall_seconds});
    }

    /** Wall seconds from the last record to the end; -1 if not known yet. */
    double
    seconds() const;

  private:
    double                                 end;
    std::vector<std::pair<double, double>> records; // times, wall seconds
  };

  /** A duration as text: `42 s`, `3 min 20 s`, `2 h 05 min`, `1 d 03 h`. */
  std::string
  duration(const double seconds);


  /** The cost of a named section of the program. */
  struct SectionTime
  {
    double calls        = 0.;
    double wall_seconds = 0.;
  };

  /** Costs by the sections' names. Only sections that were entered. */
  using SectionTimes = std::map<std::string, SectionTime>;

  /**
   * The costs of the timer's sections so far, plus those of the run @p before
   * it was resumed.
   */
  SectionTimes
  section_times(const TimerOutput &timer, const SectionTimes &before = {});

  /**
   * Writes timings.csv with the columns `section,calls,wall_seconds,share`, the
   * times of rank 0, and a last row `total`. A share is the section's fraction
   * of @p total_seconds. Collective.
   * @throws std::runtime_error, on all ranks, with path and reason
   */
  void
  write_timings(const std::string  &path,
                const SectionTimes &sections,
                const double        total_seconds,
                const MPI_Comm      comm);


  /** A step as one line of text.
   *  @param wall_seconds since this program began
   *  @param seconds_left as TimeLeft::seconds() */
  std::string
  progress_line(const StatisticsRow &row,
                const double         end_time,
                const double         wall_seconds,
                const double         seconds_left);

  /** The summary at the end: several lines, without the last newline.
   *  @param outcome e.g. "Finished: End time reached" */
  std::string
  summary_block(const std::string   &outcome,
                const unsigned int   dimension,
                const StatisticsRow &row,
                const unsigned int   rejected_steps,
                const std::string   &directory);

  /**
   * Tells the user what happens: the terminal and log.txt get one line a step,
   * with the time left. Only rank 0 writes. Members are collective unless they
   * say otherwise.
   */
  class Progress
  {
  public:
    /**
     * @param log_path   path of log.txt
     * @param resume     continue the log
     * @param start_time simulated time at which this program begins, day
     * @throws std::runtime_error if the log cannot be written; so do all
     *         members
     */
    Progress(const std::string &log_path,
             const bool         resume,
             const double       start_time,
             const double       end_time,
             const MPI_Comm     comm);

    /** Shows a message, of one or more lines, and logs it.
     *  @param shown false: it is only logged */
    void
    message(const std::string &text, const bool shown = true);

    /** Reports an accepted step. */
    void
    step(const StatisticsRow &row, const double wall_seconds)
    {
      time_left.add(row.time, wall_seconds);
      message(progress_line(row, end_time, wall_seconds, time_left.seconds()));
    }

    /**
     * Writes @p text, the reason why the program ends, into the log only, where
     * possible. Not collective.
     */
    void
    fail(const std::string &text) noexcept;

  private:
    MPI_Comm                    comm;
    double                      end_time;
    TimeLeft                    time_left;
    std::unique_ptr<OutputFile> log; // on rank 0
  };
} // namespace Morula

#endif
