// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/events.h>
#include <morula/output/forces.h>
#include <morula/output/lineage.h>
#include <morula/output/matrix_condition.h>
#include <morula/output/newton_trace.h>
#include <morula/output/statistics.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/simulation/run_tables.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** A row with the columns that a run of this scene has. */
    template <int dim>
    StatisticsRow
    row_like(const TissueModel<dim> &model)
    {
      // The values do not matter: a column exists where the row has a value for
      // it.
      StatisticsRow row;
      for (const auto &column : model.tables.columns())
        row.of_effects.emplace_back(column.name, 0.);
      if (has_surface(model))
        row.surface.emplace();
      if (model.development.states_error())
        row.step_error = 0.;
      return row;
    }
  } // namespace


  template <int dim>
  std::vector<Table>
  tables_of(const TissueModel<dim> &model)
  {
    // The first tables follow from what acts in the scene, which a resumed run
    // cannot change. The others follow from keys that it may change, or came
    // with a later version: they may begin later.
    const Scene       &scene  = model.scene;
    std::vector<Table> tables = {
      {"statistics", statistics_columns(row_like(model))},
      {"lineage", lineage_columns(!scene.type_names().empty())}};
    if (model.tables.records_events())
      tables.push_back(
        {"events", event_columns({{}, model.tables.has_causes()})});
    if (Scene::has_any(scene.catalogue.boundary_conditions) ||
        Scene::has_any(scene.catalogue.interactions))
      tables.push_back({"forces", force_columns(), true});
    if (scene.output.condition_estimate)
      tables.push_back({"condition", condition_columns(), true});
    if (scene.output.newton_trace)
      tables.push_back({"newton", newton_columns(), true});
    return tables;
  }


  MORULA_INSTANTIATE(tables_of);
} // namespace Morula
