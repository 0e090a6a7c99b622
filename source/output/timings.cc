// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/output_file.h>
#include <morula/output/table.h>
#include <morula/output/timings.h>

namespace Morula
{
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
} // namespace Morula
