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
  /** What statistics.csv says of death. */
  struct DeathCounts
  {
    std::uint64_t dying   = 0; // dead cells that are still there
    std::uint64_t deaths  = 0; // in this step
    std::uint64_t removed = 0; // in this step
    std::uint64_t pieces  = 0; // that hold cells, on the grid of the step
  };

  /** What statistics.csv says of a lumen. */
  struct LumenState
  {
    double volume   = 0.; // µm^dim
    double pressure = 0.; // kPa, above that around the tissue
  };

  /** What statistics.csv says of a field. */
  struct FieldStatistics
  {
    std::string   name;
    double        min = 0., mean = 0., max = 0.; // mean over the volume
    std::uint64_t clipped = 0; // values < 0 that were set to 0 in this step
  };

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
    /** The numbers of cells, by the names of their types; empty without types.
     *  */
    std::vector<std::pair<std::string, std::uint64_t>> cells_of_types = {};
    /** The deaths; empty where no cells can die. */
    std::optional<DeathCounts> death = {};
    /** The state of the lumen; empty without one. */
    std::optional<LumenState> lumen = {};
    /** The statistics of the fields, by their numbers; empty without fields. */
    std::vector<FieldStatistics> fields = {};
    /** How the surface fits the cells; empty without boundary points. */
    std::optional<SurfaceFit> surface = {};
    /** What the step before missed of growth and flow, relative to the volume;
     *  only where they follow the state. */
    std::optional<double> step_error = {};

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
