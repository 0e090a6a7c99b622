// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/cell_growth.h>

namespace Morula
{
  template <int dim>
  CellGrowth<dim>::CellGrowth(std::unique_ptr<const GrowthLaw<dim>>    law,
                              std::optional<CellCycle<dim>>            cycle,
                              std::unique_ptr<const DivisionRule<dim>> rule)
    : law(std::move(law))
    , cycle_(std::move(cycle))
    , rule(std::move(rule))
  {
    if (this->law)
      columns_.need_growth();
    if (cycle_)
      cycle_columns.emplace(columns_);
  }

  template <int dim>
  bool
  CellGrowth<dim>::present() const
  {
    return law || cycle_;
  }

  template <int dim>
  const CellCycle<dim> *
  CellGrowth<dim>::cycle() const
  {
    return cycle_ ? &*cycle_ : nullptr;
  }

  template <int dim>
  const CellColumns<dim> &
  CellGrowth<dim>::columns() const
  {
    return columns_;
  }

  template <int dim>
  CycleState<dim>
  CellGrowth<dim>::clock(const CellView<dim, const double> &cell) const
  {
    return cycle_columns->load(cell);
  }

  template <int dim>
  void
  CellGrowth<dim>::set_clock(const CellView<dim, double> &cell,
                             const CycleState<dim>       &state) const
  {
    cycle_columns->store(state, cell);
  }

  template <int dim>
  void
  CellGrowth<dim>::initialize(const types::particle_index  id,
                              const CellView<dim, double> &cell) const
  {
    if (!cycle_)
      return;
    const Point<dim> X     = cell.founder_position();
    CycleState<dim>  state = cycle_->founder(id, X);
    choose_axis(CycleState<dim>(), X, unit_symmetric_tensor<dim>(), state);
    set_clock(cell, state);
  }

  template <int dim>
  CycleState<dim>
  CellGrowth<dim>::advance(const CellView<dim, const double> &cell,
                           const double                       t0,
                           const double                       t1) const
  {
    const CycleState<dim> before = clock(cell);
    const Point<dim>      X      = cell.founder_position();
    CycleState<dim>       after =
      cycle_->advance(before, X, t0, t1, cell.elastic_volume_ratio());
    if (rule)
      choose_axis(before, X, cell.elastic_deformation(), after);
    return after;
  }

  template <int dim>
  void
  CellGrowth<dim>::choose_axis(const CycleState<dim> &before,
                               const Point<dim>      &X,
                               const Tensor<2, dim>  &F_e,
                               CycleState<dim>       &after) const
  {
    if (!rule || after.phase != CyclePhase::growing ||
        before.phase == CyclePhase::growing)
      return;
    const Tensor<1, dim> axis = rule->axis({X, F_e, after.axis});
    after.axis                = axis / axis.norm();
  }

  template <int dim>
  Tensor<2, dim>
  CellGrowth<dim>::growth(const CellView<dim, const double> &cell,
                          const double                       t0,
                          const double                       t1) const
  {
    const Point<dim> X = cell.founder_position();
    Tensor<2, dim>   of_cycle(unit_symmetric_tensor<dim>());
    Tensor<2, dim>   of_law = cell.growth(); // at t0
    if (cycle_)
      {
        if (law)
          of_law = of_law * invert(cycle_->growth(clock(cell), X, t0));
        of_cycle = cycle_->growth(advance(cell, t0, t1), X, t1);
      }
    if (!law)
      return of_cycle;
    return law->growth({X, of_law, cell.elastic_deformation(), &cell}, t0, t1) *
           of_cycle;
  }

  template <int dim>
  GrowthOfStep<dim>
  CellGrowth<dim>::of_step(const Tissue<dim> &tissue,
                           const double       t0,
                           const double       t1) const
  {
    GrowthOfStep<dim> growth_of_step;
    growth_of_step.present = present();
    if (!present())
      return growth_of_step;
    const Cells<dim> &cells = tissue.cells();
    growth_of_step.previous.reserve(cells.size());
    growth_of_step.current.reserve(cells.size());
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        growth_of_step.previous.push_back(cells.growth(p));
        growth_of_step.current.push_back(growth(cells[p], t0, t1));
      }
    return growth_of_step;
  }

  template <int dim>
  void
  CellGrowth<dim>::commit(const CellView<dim, double> &cell,
                          const double                 t0,
                          const double                 t1,
                          const Tensor<2, dim>        &F_g) const
  {
    if (!present())
      return;
    if (cycle_)
      set_clock(cell, advance(cell, t0, t1));
    cell.set(columns_.growth, F_g);
  }

  template class CellGrowth<2>;
  template class CellGrowth<3>;
} // namespace Morula
