// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_progress_h
#define morula_output_progress_h

#include <morula/output/log.h>
#include <morula/output/time_left.h>
#include <morula/output/timings.h>

#include <mpi.h>

#include <cstdint>
#include <string>

namespace Morula
{
  /** What is shown of a step. */
  struct StepReport
  {
    unsigned int  step              = 0;
    double        time              = 0.; // at its end, day
    double        dt                = 0.; // day
    std::uint64_t cells             = 0;
    unsigned int  newton_iterations = 0;
    double        wall_seconds      = 0.; // since this program began
  };

  /** What is shown at the end. */
  struct RunSummary
  {
    std::string   outcome; // e.g. "Finished: End time reached"
    unsigned int  dimension      = 3;
    double        time           = 0.; // day
    std::uint64_t cells          = 0;
    double        volume         = 0.; // µm^dim
    unsigned int  steps          = 0;
    unsigned int  rejected_steps = 0;
    double        wall_seconds   = 0.; // across resumes
    SectionTimes  sections;
    std::string   directory;
  };

  /** A step as a line of its own. @p seconds_left as in TimeLeft. */
  std::string
  progress_line(const StepReport &report,
                const double      end_time,
                const double      seconds_left);

  /**
   * A step as a bar that is shorter than @p width characters; parts that do not
   * fit are left out.
   */
  std::string
  progress_bar(const StepReport  &report,
               const double       start_time,
               const double       end_time,
               const double       seconds_left,
               const unsigned int width);

  /** The block at the end, several lines without the last newline. */
  std::string
  summary_block(const RunSummary &summary);

  /**
   * Tells the user what happens: on a terminal a bar with the time left that
   * changes in place, elsewhere one line a step. log.txt gets what elsewhere
   * gets. Rank 0 speaks; members are collective unless said otherwise.
   */
  class Progress
  {
  public:
    /**
     * @param log_path   log.txt
     * @param resume     continue the log
     * @param start_time where this program begins, day
     * @throws std::runtime_error if the log cannot be written, as all members
     */
    Progress(const std::string &log_path,
             const bool         resume,
             const double       start_time,
             const double       end_time,
             const MPI_Comm     comm);

    /** Lines about something worth knowing. */
    void
    message(const std::string &text);

    /** Reports an accepted step. */
    void
    step(const StepReport &report);

    /** The last lines of a run that came to its end. */
    void
    finish(const RunSummary &summary);

    /**
     * Ends the bar and puts @p text into the log only, where possible: for what
     * ends the program. Not collective.
     */
    void
    fail(const std::string &text) noexcept;

  private:
    void
    clear_bar();

    double   start_time;
    double   end_time;
    bool     speaks; // rank 0
    bool     bar_shown = false;
    TimeLeft time_left;
    Log      log;
  };
} // namespace Morula

#endif
