// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_timings_h
#define morula_output_timings_h

#include <deal.II/base/timer.h>

#include <mpi.h>

#include <map>
#include <string>

namespace Morula
{
  using namespace dealii;

  /** What a named phase of the steps has cost. */
  struct SectionTime
  {
    double calls        = 0.;
    double wall_seconds = 0.;
  };

  /** By the sections' names; only sections that were entered. */
  using SectionTimes = std::map<std::string, SectionTime>;

  /**
   * The timer's sections so far, added to those of the run before it was
   * resumed.
   */
  SectionTimes
  section_times(const TimerOutput &timer, const SectionTimes &before = {});

  /**
   * Writes timings.csv, `section,calls,wall_seconds,share`, with rank 0's
   * times, and a last row `total`. Shares are of @p total_seconds. Collective.
   * @throws std::runtime_error, on all ranks, with path and reason
   */
  void
  write_timings(const std::string  &path,
                const SectionTimes &sections,
                const double        total_seconds,
                const MPI_Comm      comm);
} // namespace Morula

#endif
