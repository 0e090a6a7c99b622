// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>

namespace Morula
{
  template <int dim>
  template <typename Number>
  CycleState<dim>
  CycleState<dim>::load(const CellView<dim, Number> &cell)
  {
    const CellSlots<dim> &slots = cell.layout();

    const auto half = [&](const unsigned int i) {
      return static_cast<std::uint64_t>(cell.scalar(slots.lineage_key + i));
    };

    CycleState state;
    state.phase =
      static_cast<CyclePhase>(static_cast<int>(cell.scalar(slots.phase)));
    state.event_time = cell.scalar(slots.event_time);
    state.key        = half(0) | (half(1) << 32);
    state.axis       = cell.vector(slots.division_axis);
    state.growth_pre = cell.tensor(slots.growth_pre);
    return state;
  }


  template <int dim>
  void
  CycleState<dim>::store(const CellView<dim, double> &cell) const
  {
    const CellSlots<dim> &slots = cell.layout();

    cell.set_scalar(slots.phase, static_cast<int>(phase));
    cell.set_scalar(slots.event_time, event_time);
    cell.set_scalar(slots.lineage_key, static_cast<std::uint32_t>(key));
    cell.set_scalar(slots.lineage_key + 1,
                    static_cast<std::uint32_t>(key >> 32));
    cell.set_vector(slots.division_axis, axis);
    cell.set_tensor(slots.growth_pre, growth_pre);
  }


  template struct CycleState<2>;
  template struct CycleState<3>;
  template CycleState<2>
  CycleState<2>::load(const CellView<2, double> &);
  template CycleState<2>
  CycleState<2>::load(const CellView<2, const double> &);
  template CycleState<3>
  CycleState<3>::load(const CellView<3, double> &);
  template CycleState<3>
  CycleState<3>::load(const CellView<3, const double> &);
} // namespace Morula
