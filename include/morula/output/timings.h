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
} // namespace Morula

#endif
