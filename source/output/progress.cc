// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/progress.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <vector>

namespace Morula
{
  namespace
  {
    template <typename... Values>
    std::string
    format(const char *pattern, const Values... values)
    {
      // Long enough for all patterns of this file.
      char text[256];
      std::snprintf(text, sizeof(text), pattern, values...);
      return text;
    }

    /** A name and its value, padded so that the values align. */
    std::string
    summary_line(const char *name, const std::string &value)
    {
      return format("\n  %-16s", name) + value;
    }
  } // namespace

  std::string
  progress_line(const StepReport &report,
                const double      end_time,
                const double      seconds_left)
  {
    std::string line = format(
      "step %u: day %.6g of %.6g, dt %.3g, %llu cells, %u Newton iterations, "
      "%s",
      report.step,
      report.time,
      end_time,
      report.dt,
      static_cast<unsigned long long>(report.cells),
      report.newton_iterations,
      duration(report.wall_seconds).c_str());
    if (seconds_left > 0.)
      line += ", about " + duration(seconds_left) + " left";
    return line;
  }

  std::string
  summary_block(const FinalReport &summary)
  {
    // The three sections of the timings that took longest are named, with their
    // share of the wall time. What a scene does not have gives no line.
    std::vector<std::pair<std::string, double>> sections;
    for (const auto &section : summary.sections)
      sections.emplace_back(section.first, section.second.wall_seconds);
    std::stable_sort(sections.begin(),
                     sections.end(),
                     [](const auto &a, const auto &b) {
                       return a.second > b.second;
                     });
    constexpr std::size_t n_shown = 3;
    sections.resize(std::min(sections.size(), n_shown));

    std::string dearest;
    for (const auto &section : sections)
      dearest += (dearest.empty() ? "" : ", ") + section.first +
                 format(" %.0f %%",
                        summary.wall_seconds > 0. ?
                          100. * section.second / summary.wall_seconds :
                          0.);

    std::string text = summary.outcome;
    text += summary_line("day", format("%.6g", summary.time));
    text += summary_line(
      "cells", format("%llu", static_cast<unsigned long long>(summary.cells)));
    text +=
      summary_line("volume",
                   format("%.6g um^%u", summary.volume, summary.dimension));
    text += summary_line("steps",
                         format("%u, %u rejected",
                                summary.steps,
                                summary.rejected_steps));
    text += summary_line("wall time", duration(summary.wall_seconds));
    if (!dearest.empty())
      text += summary_line("spent mostly in", dearest);
    if (summary.error_in_time)
      text += summary_line("error in time",
                           format("about %.2g %% of growth and strain",
                                  100. * *summary.error_in_time));
    text += summary_line("files in", summary.directory);
    return text;
  }

  Progress::Progress(const std::string &log_path,
                     const bool         resume,
                     const double       start_time,
                     const double       end_time,
                     const MPI_Comm     comm)
    : comm(comm)
    , end_time(end_time)
    , time_left(start_time, end_time)
  {
    on_root(comm, [&]() {
      log = std::make_unique<OutputFile>(log_path,
                                         resume ? OutputFile::Mode::append :
                                                  OutputFile::Mode::create);
    });
  }

  void
  Progress::message(const std::string &text)
  {
    on_root(comm, [&]() {
      std::cout << text << std::endl;
      log->write(text + '\n');
    });
  }

  void
  Progress::step(const StepReport &report)
  {
    time_left.add(report.time, report.wall_seconds);
    message(progress_line(report, end_time, time_left.seconds()));
  }

  void
  Progress::fail(const std::string &text) noexcept
  {
    try
      {
        if (log)
          log->write(text + '\n');
      }
    catch (const std::exception &)
      {
        // The error that is being reported matters more than this one.
      }
  }
} // namespace Morula
