// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/progress.h>
#include <morula/output/table.h>

#include <cmath>
#include <cstdio>
#include <iostream>

namespace Morula
{

  double
  TimeLeft::seconds() const
  {
    // The work so far is taken as a power of the simulated time, whose exponent
    // follows from the first and the second half: tissue that grows takes
    // longer and longer. The rest of the run follows by the same power.
    const auto [first, set_up] = records.front();
    const double last          = records.back().first;
    const double spent         = records.back().second - set_up;
    const double done          = last - first;
    if (done <= 0. || spent <= 0.)
      return -1.;
    if (last >= end)
      return 0.;

    // The wall time at half of the simulated time is interpolated between
    // records.
    const double half   = first + 0.5 * done;
    const auto   after  = std::lower_bound(records.begin() + 1,
                                        records.end(),
                                        half,
                                        [](const auto &record, const double t) {
                                          return record.first < t;
                                        });
    const auto   before = *(after - 1);
    const double weight = (half - before.first) / (after->first - before.first);
    const double spent_at_half =
      before.second + weight * (after->second - before.second) - set_up;

    // A few steps say nothing about growth, so they count as even. The lower
    // bound holds where the set-up outweighs the first steps, the upper one
    // where cells have doubled four times.
    const double exponent =
      records.size() > 4 && spent_at_half > 0. ?
        std::clamp(std::log2(spent / spent_at_half), 0.5, 4.) :
        1.;
    return spent * (std::pow((end - first) / done, exponent) - 1.);
  }

  std::string
  duration(const double seconds)
  {
    const long long s = std::llround(seconds);
    char            text[64];
    if (s < 60)
      std::snprintf(text, sizeof(text), "%lld s", s);
    else if (s < 3600)
      std::snprintf(text, sizeof(text), "%lld min %02lld s", s / 60, s % 60);
    else if (s < 86400)
      std::snprintf(
        text, sizeof(text), "%lld h %02lld min", s / 3600, s / 60 % 60);
    else
      std::snprintf(
        text, sizeof(text), "%lld d %02lld h", s / 86400, s / 3600 % 24);
    return text;
  }


  SectionTimes
  section_times(const TimerOutput &timer, const SectionTimes &before)
  {
    SectionTimes times = before;
    // A resumed run goes on from the times of the snapshot.
    for (const auto &section :
         timer.get_summary_data(TimerOutput::total_wall_time))
      times[section.first].wall_seconds += section.second;
    for (const auto &section : timer.get_summary_data(TimerOutput::n_calls))
      times[section.first].calls += section.second;
    return times;
  }

  void
  write_timings(const std::string  &path,
                const SectionTimes &sections,
                const double        total_seconds,
                const MPI_Comm      comm)
  {
    std::string text;
    const auto  add = [&](const std::string &name, const SectionTime &time) {
      const TableRow row = {
        {"section", name},
        {"calls", time.calls},
        {"wall_seconds", time.wall_seconds},
        {"share", total_seconds > 0. ? time.wall_seconds / total_seconds : 0.}};
      text += (text.empty() ? row.header() : "") + row.text();
    };
    for (const auto &section : sections)
      add(section.first, section.second);
    // The total is no sum of the sections, which do not cover all of the run.
    add("total", {1., total_seconds});

    on_root(comm, [&]() { write_atomically(path, text); });
  }


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
  progress_line(const StatisticsRow &row,
                const double         end_time,
                const double         wall_seconds,
                const double         seconds_left)
  {
    // Short enough for a terminal of 80 columns.
    std::string line =
      format("step %u: day %.6g of %.6g, %llu cells, %u iterations, %s",
             row.step,
             row.time,
             end_time,
             static_cast<unsigned long long>(row.cells),
             row.newton_iterations,
             duration(wall_seconds).c_str());
    if (seconds_left > 0.)
      line += ", " + duration(seconds_left) + " left";
    return line;
  }

  std::string
  summary_block(const std::string   &outcome,
                const unsigned int   dimension,
                const StatisticsRow &row,
                const unsigned int   rejected_steps,
                const std::string   &directory)
  {
    return outcome + summary_line("day", format("%.6g", row.time)) +
           summary_line("cells",
                        format("%llu",
                               static_cast<unsigned long long>(row.cells))) +
           summary_line("volume",
                        format("%.6g um^%u",
                               row.tissue.total_volume,
                               dimension)) +
           summary_line("steps",
                        format("%u, %u rejected", row.step, rejected_steps)) +
           summary_line("wall time", duration(row.wall_seconds)) +
           summary_line("error in time",
                        row.step_error ?
                          format("about %.2g %% of growth and strain",
                                 100. * *row.step_error) :
                          "none to estimate") +
           summary_line("files in", directory);
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
  Progress::message(const std::string &text, const bool shown)
  {
    on_root(comm, [&]() {
      if (shown)
        std::cout << text << std::endl;
      log->write(text + '\n');
    });
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
