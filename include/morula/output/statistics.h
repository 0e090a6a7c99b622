// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_statistics_h
#define morula_output_statistics_h

#include <morula/output/longest_cell.h>
#include <morula/output/tissue_sums.h>
#include <morula/particles/surface_fit.h>

#include <cstdint>
#include <optional>
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
    unsigned int  turns          = 0; // equilibria, including rejected attempts
    unsigned int  proximal_paths = 0; // likewise
    double        residual       = 0.; // relative to the step's first
    double        wall_seconds   = 0.; // since the start, across resumes
    CellLengths   lengths;
    /** Columns of the scene's effects, by name: Tables::columns(). */
    std::vector<std::pair<std::string, double>> of_effects = {};
    /** How the surface fits the cells; empty without boundary points. */
    std::optional<SurfaceFit> surface = {};
    /** What the step before missed of growth and flow, relative to the volume;
     *  only where they follow the state. */
    std::optional<double> step_error = {};

    /** A column of the effects. @throws std::out_of_range */
    double &
    of_effect(const std::string &name);
    double
    of_effect(const std::string &name) const
    {
      return const_cast<StatisticsRow *>(this)->of_effect(name);
    }

    /** Names and values of the file's columns, in their order. */
    std::vector<std::pair<std::string, double>>
    columns() const;
  };

  /** The names of the columns of statistics.csv. @param like a row with the
   *  columns of all rows */
  std::vector<std::string>
  statistics_columns(const StatisticsRow &like);

  /** The row as it stands in the file. */
  std::string
  statistics_row(const StatisticsRow &row);
} // namespace Morula

#endif
