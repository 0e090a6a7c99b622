// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_statistics_h
#define morula_output_statistics_h

#include <morula/output/appended_csv.h>
#include <morula/output/longest_cell.h>
#include <morula/output/tissue_sums.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** One row of statistics.csv: the state after a step, and the step's cost. */
  struct StatisticsRow
  {
    unsigned int  step  = 0;
    double        time  = 0.; // day
    double        dt    = 0.; // day
    std::uint64_t cells = 0;
    TissueTotals  tissue;
    std::uint64_t dividing           = 0; // divisions in this step
    std::uint64_t held_at_checkpoint = 0;
    std::uint64_t active_grid_cells  = 0;
    std::uint64_t inner_splines      = 0;
    std::uint64_t outer_splines      = 0;
    std::uint64_t unknowns           = 0;
    unsigned int  newton_iterations  = 0; // including rejected attempts
    unsigned int  linear_iterations  = 0; // including rejected attempts
    unsigned int  rejected_steps     = 0;
    double        residual           = 0.; // relative to the step's first
    double        wall_seconds       = 0.; // since the start, across resumes
    CellLengths   lengths;
    /** By the types' names; empty without types. */
    std::vector<std::pair<std::string, std::uint64_t>> cells_of_types = {};

    /** Names and values of the file's columns, in their order. */
    std::vector<std::pair<std::string, double>>
    columns() const;
  };

  /** statistics.csv. All members are collective and throw as those of
   *  AppendedCsv. */
  class StatisticsFile
  {
  public:
    /** Starts a new file. @param type_names of the cells, if they have types */
    StatisticsFile(const std::string              &path,
                   const std::vector<std::string> &type_names,
                   const MPI_Comm                  comm);

    /** Continues the file behind the rows that are to be @p kept. */
    StatisticsFile(const std::string              &path,
                   const std::vector<std::string> &type_names,
                   const TableExtent              &kept,
                   const MPI_Comm                  comm);

    /** See AppendedCsv. */
    static void
    check(const std::string              &path,
          const std::vector<std::string> &type_names,
          const TableExtent              &kept,
          const MPI_Comm                  comm);

    /** Appends a row. */
    void
    append(const StatisticsRow &row);

    /** See AppendedCsv. */
    void
    sync()
    {
      file.sync();
    }

    TableExtent
    extent() const
    {
      return file.extent();
    }

  private:
    AppendedCsv file;
  };
} // namespace Morula

#endif
