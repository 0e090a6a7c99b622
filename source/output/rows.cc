// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/rows.h>

namespace Morula
{
  namespace
  {
    void
    add_vector(const std::string  &name,
               const Tensor<1, 3> &vector,
               TableRow           &row)
    {
      for (unsigned int d = 0; d < 3; ++d)
        row.add(name + '_' + "xyz"[d], vector[d]);
    }
  } // namespace

  TableRow
  statistics_row(const StatisticsRow &row)
  {
    // The columns and their order are a contract: others read them by name.
    // What a scene does not have gives no columns, so they come last, effect by
    // effect.
    TableRow list = {
      {"step", row.step},
      {"time", row.time},
      {"dt", row.dt},
      {"cells", row.cells},
      {"total_volume", row.tissue.total_volume},
      {"grown_volume", row.tissue.grown_volume},
      {"mean_energy_density", row.tissue.mean_energy_density},
      {"cell_mean_energy_density", row.tissue.cell_mean_energy_density},
      {"max_energy_density", row.tissue.max_energy_density},
      {"min_elastic_volume_ratio", row.tissue.min_elastic_volume_ratio},
      {"max_elastic_volume_ratio", row.tissue.max_elastic_volume_ratio},
      {"dividing", row.dividing},
      {"held_at_checkpoint", row.held_at_checkpoint},
      {"xmin", row.tissue.lower[0]},
      {"xmax", row.tissue.upper[0]},
      {"ymin", row.tissue.lower[1]},
      {"ymax", row.tissue.upper[1]},
      {"zmin", row.tissue.lower[2]},
      {"zmax", row.tissue.upper[2]},
      {"active_grid_cells", row.active_grid_cells},
      {"inner_splines", row.inner_splines},
      {"outer_splines", row.outer_splines},
      {"unknowns", row.unknowns},
      {"newton_iterations", row.newton_iterations},
      {"linear_iterations", row.linear_iterations},
      {"rejected_steps", row.rejected_steps},
      {"residual", row.residual},
      {"wall_seconds", row.wall_seconds},
      {"min_cells_per_spacing", row.lengths.min_cells_per_spacing},
      {"turns", row.turns},
      {"proximal_paths", row.proximal_paths}};
    if (row.step_error)
      list.add("step_error", *row.step_error);
    for (const auto &[name, value] : row.of_effects)
      list.add(name, value);
    if (row.surface)
      {
        list.add("surface_distance", row.surface->distance);
        list.add("enclosed_volume", row.surface->enclosed);
      }
    return list;
  }

  template <int dim>
  TableRow
  lineage_row(const Birth<dim> &birth, const bool with_types)
  {
    // In 2-D z is 0.
    TableRow row = {{"id", birth.id},
                    {"parent", birth.parent},
                    {"generation", birth.generation},
                    {"birth_time", birth.time},
                    {"x", birth.position[0]},
                    {"y", birth.position[1]},
                    {"z", dim == 3 ? birth.position[dim - 1] : 0.}};
    if (with_types)
      row.add("type", birth.type);
    for (const auto &[name, value] : birth.numbers)
      row.add(name, value);
    return row;
  }

  template <int dim>
  std::string
  lineage_rows(const std::vector<Birth<dim>> &births,
               const bool                     with_types,
               const MPI_Comm                 comm)
  {
    std::vector<std::string>           rows;
    std::vector<types::particle_index> ids;
    for (const Birth<dim> &birth : births)
      {
        rows.push_back(lineage_row(birth, with_types).text());
        ids.push_back(birth.id);
      }
    return rows_in_order(std::move(ids), rows, comm);
  }

  TableRow
  event_row(const CellEvent &event, const EventsContents &contents)
  {
    // What has no type to go to leaves `to` empty, what has no cause leaves
    // `cause` empty.
    const auto type = [&](const unsigned int number) {
      return contents.type_names.empty() ? "" : contents.type_names[number];
    };
    const bool changes = event.kind == CellEvent::transition;
    TableRow   row     = {{"time", event.time},
                          {"id", event.id},
                          {"event", std::string(event.kind.name)},
                          {"from", type(event.from)},
                          {"to", changes ? type(event.to) : ""}};
    if (contents.with_causes)
      row.add("cause", std::string(event.cause));
    return row;
  }

  std::string
  event_rows(const std::vector<CellEvent> &events,
             const EventsContents         &contents,
             const MPI_Comm                comm)
  {
    std::vector<std::string>           rows;
    std::vector<std::array<double, 3>> keys;
    for (const CellEvent &event : events)
      {
        rows.push_back(event_row(event, contents).text());
        keys.push_back({{event.time, 1. * event.id, 1. * event.kind.order}});
      }
    // Several changes of a cell at one time stay in their order: each ends
    // where the next one begins.
    return rows_in_order(std::move(keys), rows, comm);
  }

  TableRow
  force_row(const double time, const ForceRow &row)
  {
    TableRow list = {{"time", time},
                     {"kind", row.kind},
                     {"name", row.name},
                     {"points", row.points},
                     {"area", row.area}};
    add_vector("force", row.force, list);
    add_vector("moment", row.moment, list);
    list.add("force_inward", row.inward);
    return list;
  }

  TableRow
  newton_row(const unsigned int step, const NewtonIteration &state)
  {
    const Equilibrium::Extreme &J = state.evaluation.smallest_J;
    return {{"step", step},
            {"attempt", state.place.attempt},
            {"turn", state.place.turn},
            {"proximity", state.place.proximity},
            {"iteration", state.iteration},
            {"energy", state.evaluation.energy},
            {"residual", state.residual},
            {"part", state.part},
            {"motion", state.motion},
            {"curvature", state.curvature},
            {"smallest_J", J.value},
            {"x", J.place[0]},
            {"y", J.place[1]},
            {"z", J.place[2]}};
  }

  TableRow
  condition_row(const unsigned int       step,
                const double             time,
                const ConditionEstimate &estimate)
  {
    return {{"step", step},
            {"time", time},
            {"unknowns", estimate.unknowns},
            {"smallest", estimate.smallest},
            {"largest", estimate.largest},
            {"condition", estimate.condition()}};
  }

  MORULA_INSTANTIATE(lineage_row);
  MORULA_INSTANTIATE(lineage_rows);
} // namespace Morula
