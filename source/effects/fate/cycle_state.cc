// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>

namespace Morula
{
  template <int dim>
  CycleColumns<dim>::CycleColumns(CellColumns<dim> &columns,
                                  const bool        own_duration,
                                  const bool        own_hazard,
                                  const bool        exit_rate_follows_state,
                                  const bool        checkpoint)
  {
    // The first five columns are always there. The others are numbers that only
    // some scenes need, so each is declared on its condition; load() puts a
    // default in its place.
    columns.need_growth();
    columns.need_lineage();
    phase = columns.template add<CyclePhase>(
      {"phase", "", "where in the cycle, a CyclePhase", CyclePhase::never});
    event_time = columns.template add<double>(
      {"event_time", "day", "end of the G0 wait, or onset of S"});
    columns.need_lineage_key();
    lineage_key_  = columns.lineage_key;
    division_axis = columns.template add<Tensor<1, dim>>(
      {"division_axis", "", "n_s of the running cycle"});
    growth_pre = columns.template add<Tensor<2, dim>>(
      {"growth_before_the_cycle",
       "",
       "F_g of the cycle before the onset of S",
       Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    if (own_duration)
      duration = columns.template add<double>(
        {"cycle_duration", "day", "T of the running cycle"});
    if (own_hazard)
      hazard = columns.template add<double>(
        {"wait_hazard", "", "rate of leaving G0, integrated over the wait"});
    if (exit_rate_follows_state)
      exit_rate = columns.template add<double>(
        {"wait_rate",
         "1/day",
         "rate of leaving G0 that the last step saw; -1: none",
         not_expected});
    if (checkpoint)
      J_e_before = columns.template add<double>(
        {"j_e_before", "", "J_e at the beginning of the step before", 1.});
  }


  template <int dim>
  CycleState<dim>
  CycleColumns<dim>::load(const CellView<dim, const double> &cell) const
  {
    // The order is that of the members of CycleState.
    return {cell.get(phase),
            cell.get(event_time),
            cell.get(lineage_key_),
            cell.get(division_axis),
            cell.get(growth_pre),
            duration.exists() ? cell.get(duration) : 0.,
            hazard.exists() ? cell.get(hazard) : 0.,
            exit_rate.exists() ? cell.get(exit_rate) : not_expected};
  }


  template <int dim>
  void
  CycleColumns<dim>::store(const CycleState<dim>       &state,
                           const CellView<dim, double> &cell) const
  {
    // What has no column is the same for all cells, or is not used.
    cell.set(phase, state.phase);
    cell.set(event_time, state.event_time);
    cell.set(lineage_key_, state.key);
    cell.set(division_axis, state.axis);
    cell.set(growth_pre, state.growth_pre);
    if (duration.exists())
      cell.set(duration, state.duration);
    if (hazard.exists())
      cell.set(hazard, state.hazard);
    if (exit_rate.exists())
      cell.set(exit_rate, state.exit_rate);
  }


  template <int dim>
  ElasticSize
  CycleColumns<dim>::size(const CellView<dim, const double> &cell,
                          const PastStep                    &past) const
  {
    // The slope is that of the last step, doc/theory.md (6.3g). In the first
    // step there is none, and J_e counts as constant.
    const double J_e = cell.elastic_volume_ratio();
    if (!J_e_before.exists() || !past.exists())
      return {J_e};
    return {J_e, (J_e - cell.get(J_e_before)) / past.length(), past.begin};
  }


  template <int dim>
  void
  CycleColumns<dim>::remember_size(const CellView<dim, const double> &before,
                                   const CellView<dim, double> &after) const
  {
    // `before` is the cell at the beginning of this step: for the next step
    // that is the beginning of the step before.
    if (J_e_before.exists())
      after.set(J_e_before, before.elastic_volume_ratio());
  }


  template class CycleColumns<2>;
  template class CycleColumns<3>;
} // namespace Morula
