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
  {}

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
  void
  CellGrowth<dim>::initialize(const types::particle_index  id,
                              const CellView<dim, double> &cell) const
  {
    if (!present())
      return;
    cell.set_tensor(cell.layout().growth,
                    Tensor<2, dim>(unit_symmetric_tensor<dim>()));
    if (!cycle_)
      return;
    cell.set_scalar(cell.layout().parent, -1.);
    cell.set_scalar(cell.layout().generation, 0.);
    const Point<dim> X     = cell.founder_position();
    CycleState<dim>  state = cycle_->founder(id, X);
    choose_axis(CycleState<dim>(), X, unit_symmetric_tensor<dim>(), state);
    state.store(cell);
  }

  template <int dim>
  template <typename Number>
  CycleState<dim>
  CellGrowth<dim>::advance(const CellView<dim, Number> &cell,
                           const double                 t0,
                           const double                 t1) const
  {
    const CycleState<dim> before = CycleState<dim>::load(cell);
    const Point<dim>      X      = cell.founder_position();
    CycleState<dim>       after =
      cycle_->advance(before, X, t0, t1, elastic_volume_ratio(cell));
    if (rule)
      choose_axis(before, X, elastic_deformation(cell), after);
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
  template <typename Number>
  Tensor<2, dim>
  CellGrowth<dim>::growth(const CellView<dim, Number> &cell,
                          const double                 t0,
                          const double                 t1) const
  {
    const Point<dim> X = cell.founder_position();
    Tensor<2, dim>   of_cycle(unit_symmetric_tensor<dim>());
    Tensor<2, dim>   of_law = cell.growth(); // at t0
    if (cycle_)
      {
        if (law)
          of_law =
            of_law * invert(cycle_->growth(CycleState<dim>::load(cell), X, t0));
        of_cycle = cycle_->growth(advance(cell, t0, t1), X, t1);
      }
    if (!law)
      return of_cycle;
    return law->growth({X, of_law, elastic_deformation(cell)}, t0, t1) *
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
    growth_of_step.previous.reserve(tissue.cells().order().size());
    growth_of_step.current.reserve(tissue.cells().order().size());
    for (const auto &particle : tissue.cells().order())
      {
        const CellView<dim, const double> cell = tissue.cell(particle);
        growth_of_step.previous.push_back(cell.growth());
        growth_of_step.current.push_back(growth(cell, t0, t1));
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
      advance(cell, t0, t1).store(cell);
    cell.set_tensor(cell.layout().growth, F_g);
  }

  template class CellGrowth<2>;
  template class CellGrowth<3>;
} // namespace Morula
