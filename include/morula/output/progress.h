// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_progress_h
#define morula_output_progress_h

#include <morula/output/output_file.h>
#include <morula/output/time_left.h>
#include <morula/output/timings.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace Morula
{
  /** What the program reports of a step. */
  struct StepReport
  {
    unsigned int  step              = 0;
    double        time              = 0.; // at its end, day
    double        dt                = 0.; // day
    std::uint64_t cells             = 0;
    unsigned int  newton_iterations = 0;
    double        wall_seconds      = 0.; // since this program began
  };

  /** What the program reports at the end of the run. */
  struct FinalReport
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
    /** Estimated, relative, if the run knows it. */
    std::optional<double> error_in_time = {};
  };

  /** A step as one line of text.
   *  @param seconds_left as TimeLeft::seconds() */
  std::string
  progress_line(const StepReport &report,
                const double      end_time,
                const double      seconds_left);

  /** The summary at the end: several lines, without the last newline. */
  std::string
  summary_block(const FinalReport &summary);

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

    /** Shows a message, of one or more lines, and logs it. */
    void
    message(const std::string &text);

    /** Reports an accepted step. */
    void
    step(const StepReport &report);

    /** Shows and logs the summary of a run that has come to its end. */
    void
    finish(const FinalReport &summary)
    {
      message(summary_block(summary));
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
