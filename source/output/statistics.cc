// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/statistics.h>

#include <stdexcept>

namespace Morula
{
  double &
  StatisticsRow::of_effect(const std::string &name)
  {
    for (auto &column : of_effects)
      if (column.first == name)
        return column.second;
    throw std::out_of_range("No effect has a column " + name + '.');
  }


  std::vector<std::pair<std::string, double>>
  StatisticsRow::columns() const
  {
    // The columns and their order are a contract: others read them by name.
    // What a scene does not have gives no columns, so they come last, effect by
    // effect. The same list gives the header and each row, so the two cannot
    // differ.
    const auto number = [](const auto count) {
      return static_cast<double>(count);
    };
    std::vector<std::pair<std::string, double>> list = {
      {"step", number(step)},
      {"time", time},
      {"dt", dt},
      {"cells", number(cells)},
      {"total_volume", tissue.total_volume},
      {"grown_volume", tissue.grown_volume},
      {"mean_energy_density", tissue.mean_energy_density},
      {"cell_mean_energy_density", tissue.cell_mean_energy_density},
      {"max_energy_density", tissue.max_energy_density},
      {"min_elastic_volume_ratio", tissue.min_elastic_volume_ratio},
      {"max_elastic_volume_ratio", tissue.max_elastic_volume_ratio},
      {"dividing", number(dividing)},
      {"held_at_checkpoint", number(held_at_checkpoint)},
      {"xmin", tissue.lower[0]},
      {"xmax", tissue.upper[0]},
      {"ymin", tissue.lower[1]},
      {"ymax", tissue.upper[1]},
      {"zmin", tissue.lower[2]},
      {"zmax", tissue.upper[2]},
      {"active_grid_cells", number(active_grid_cells)},
      {"inner_splines", number(inner_splines)},
      {"outer_splines", number(outer_splines)},
      {"unknowns", number(unknowns)},
      {"newton_iterations", number(newton_iterations)},
      {"linear_iterations", number(linear_iterations)},
      {"rejected_steps", number(rejected_steps)},
      {"residual", residual},
      {"wall_seconds", wall_seconds},
      {"min_cells_per_spacing", lengths.min_cells_per_spacing},
      {"turns", number(turns)},
      {"proximal_paths", number(proximal_paths)}};
    if (step_error)
      list.emplace_back("step_error", *step_error);
    list.insert(list.end(), of_effects.begin(), of_effects.end());
    if (surface)
      {
        list.emplace_back("surface_distance", surface->distance);
        list.emplace_back("enclosed_volume", surface->enclosed);
      }
    return list;
  }

  std::vector<std::string>
  statistics_columns(const StatisticsRow &like)
  {
    std::vector<std::string> names;
    for (const auto &column : like.columns())
      names.push_back(column.first);
    return names;
  }

  std::string
  statistics_row(const StatisticsRow &row)
  {
    std::vector<double> values;
    for (const auto &column : row.columns())
      values.push_back(column.second);
    return csv_row(values.data(), values.size());
  }
} // namespace Morula
