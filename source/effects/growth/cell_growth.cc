// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/cell_growth.h>

namespace Morula
{
  template <int dim>
  CellGrowth<dim>::CellGrowth(std::optional<IsotropicGrowth> isotropic,
                              std::optional<CellCycle<dim>>  cycle)
    : isotropic(std::move(isotropic))
    , cycle_(std::move(cycle))
  {}

  template <int dim>
  bool
  CellGrowth<dim>::present() const
  {
    return isotropic || cycle_;
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
    cycle_->founder(id, cell.founder_position()).store(cell);
  }

  template <int dim>
  template <typename Number>
  Tensor<2, dim>
  CellGrowth<dim>::growth(const CellView<dim, Number> &cell,
                          const double                 t0,
                          const double                 t1) const
  {
    const Point<dim> X = cell.founder_position();
    Tensor<2, dim>   F_g(unit_symmetric_tensor<dim>());
    if (cycle_)
      F_g = cycle_->growth(cycle_->advance(CycleState<dim>::load(cell),
                                           X,
                                           t0,
                                           t1,
                                           elastic_volume_ratio(cell)),
                           X,
                           t1);
    if (isotropic)
      F_g *= isotropic->stretch(X, t1);
    return F_g;
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
      cycle_
        ->advance(CycleState<dim>::load(cell),
                  cell.founder_position(),
                  t0,
                  t1,
                  elastic_volume_ratio(cell))
        .store(cell);
    cell.set_tensor(cell.layout().growth, F_g);
  }

  template class CellGrowth<2>;
  template class CellGrowth<3>;
} // namespace Morula
