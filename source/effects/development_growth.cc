// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>

// The parts of F_g and their product: doc/theory.md (8.7).

namespace Morula
{
  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::growth_left_of_cycle(
    const CellView<dim, const double> &cell, const double t) const
  {
    const Tensor<2, dim> F_g = cell.growth();
    if (!effects.cycle)
      return F_g;
    const CycleState<dim> state = clock(cell);
    if (state.phase == CyclePhase::never)
      return F_g;
    return F_g *
           invert(effects.cycle->growth(state, cell.founder_position(), t));
  }

  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::growth_behind_law(
    const CellView<dim, const double> &cell,
    const CycleState<dim>             &clock,
    const double                       t) const
  {
    if (effects.cycle)
      return effects.cycle->growth(clock, cell.founder_position(), t);
    return effects.relaxed.exists() ?
             cell.get(effects.relaxed) :
             Tensor<2, dim>(unit_symmetric_tensor<dim>());
  }

  template <int dim>
  GrowingCell<dim>
  CellDevelopment<dim>::growing(const PresentCell<dim> &cell,
                                const double            t0) const
  {
    const CellView<dim, const double> &view = cell.cell();
    Tensor<2, dim>                     at_t0;
    if (effects.law_growth.exists())
      at_t0 = view.get(effects.law_growth);
    else if (effects.cycle)
      at_t0 = view.growth() * invert(growth_behind_law(view, clock(view), t0));
    else if (effects.relaxed.exists())
      at_t0 = view.growth() * invert(view.get(effects.relaxed));
    else
      at_t0 = view.growth();
    return {
      view.founder_position(), at_t0, view.elastic_deformation(), &view, &cell};
  }

  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::law_growth(const GrowingCell<dim> &cell,
                                   const double            t0,
                                   const double            t1) const
  {
    if (!effects.grows.empty() && !effects.grows[cell.present->type()])
      return cell.growth;
    return effects.law->growth(cell, t0, t1);
  }

  template <int dim>
  double
  CellDevelopment<dim>::free_growth(std::vector<double>         row,
                                    const types::particle_index id,
                                    const double                end,
                                    const unsigned int          n_steps) const
  {
    double ratio = 1.;
    for (unsigned int n = 0; n < n_steps; ++n)
      {
        const double t0 = n * end / n_steps, t1 = (n + 1) * end / n_steps;
        std::vector<double>         next = row;
        const CellView<dim, double> cell(make_array_view(row), columns_);
        const CellView<dim, double> after(make_array_view(next), columns_);
        const CellReader<dim>       reader =
          this->reader(t0, {t0 - (n > 0 ? end / n_steps : 0.), t0});
        const PresentCell<dim> before(cell,
                                      id,
                                      cell.founder_position(),
                                      reader);
        const GrowingCell<dim> growing = this->growing(before, t0);
        const Tensor<2, dim>   of_law  = law_growth(growing, t0, t1);
        effects.law->remember(growing, t0, t1, after);
        if (effects.law_growth.exists())
          after.set(effects.law_growth, of_law);
        const Tensor<2, dim> F_g =
          of_law * growth_behind_law(
                     cell, effects.cycle ? clock(cell) : CycleState<dim>(), t1);
        after.set(columns_.growth, F_g);
        after.set(columns_.deformation, F_g);
        row   = next;
        ratio = determinant(of_law);
      }
    return ratio;
  }

  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::growth(const PresentCell<dim> &cell,
                               const CycleState<dim>  &next,
                               const double            t0,
                               const double            t1) const
  {
    const Tensor<2, dim> behind = growth_behind_law(cell.cell(), next, t1);
    return effects.law ? law_growth(growing(cell, t0), t0, t1) * behind :
                         behind;
  }

  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::living_growth(const PresentCell<dim>      &before,
                                      const CellView<dim, double> &after,
                                      const CycleState<dim>       &next,
                                      const double                 t0,
                                      const double                 t1,
                                      double                      &missed) const
  {
    Tensor<2, dim> F_g = growth_behind_law(before.cell(), next, t1);
    if (effects.law)
      {
        const GrowingCell<dim> growing = this->growing(before, t0);
        GrowthOfStep<dim>      of_law{growing.growth};
        if (effects.grows.empty() || effects.grows[before.type()])
          of_law = effects.law->grow(growing, t0, t1, after);
        else
          effects.law->remember(growing, t0, t1, after);
        missed = of_law.missed;
        if (effects.law_growth.exists())
          after.set(effects.law_growth, of_law.growth);
        F_g = of_law.growth * F_g;
      }
    if (effects.contraction)
      F_g = effects.contraction->strain(before, after, t1) * F_g;
    // With the growth of t0 nothing would be left of F_e.
    if (effects.forgets_stress && after.get(state_.type) != before.type())
      F_g = absorb(before.elastic(), F_g, after);
    return F_g;
  }

  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::relax(const PresentCell<dim>      &before,
                              const CellView<dim, double> &after,
                              const Tensor<2, dim>        &F_g,
                              const double                 t0,
                              const double                 t1,
                              double                      &share) const
  {
    // A cell that has forgotten its stress in this step begins without it.
    const bool forgets =
      effects.forgets_stress && after.get(state_.type) != before.type();
    const auto [D, part] = effects.relaxation->flow(
      before, forgets ? F_g : before.cell().growth(), F_g, t0, t1);
    share = part;
    return D == Tensor<2, dim>(unit_symmetric_tensor<dim>()) ?
             F_g :
             absorb(D, F_g, after);
  }

  template <int dim>
  void
  CellDevelopment<dim>::remember_motion(const CellView<dim, double> &cell,
                                        const Tensor<2, dim>        &f) const
  {
    if (effects.relaxation)
      effects.relaxation->remember_motion(cell, f);
  }

  template <int dim>
  double
  CellDevelopment<dim>::missed_flow(const CellView<dim, const double> &cell,
                                    const unsigned int                 p,
                                    const Tensor<2, dim>              &f,
                                    const DevelopmentOfStep<dim>      &of_step,
                                    const double                       t0,
                                    const double                       t1) const
  {
    return of_step.flow_shares.empty() ?
             0. :
             of_step.flow_shares[p] * effects.relaxation->error_of_forecast(
                                        cell, f, of_step.past, t1 - t0);
  }

  template <int dim>
  bool
  CellDevelopment<dim>::states_error() const
  {
    return effects.states_error();
  }

  template <int dim>
  std::vector<double>
  CellDevelopment<dim>::missed_growth(const Tissue<dim> &tissue,
                                      const double       t0,
                                      const PastStep    &past) const
  {
    std::vector<double> missed;
    if (!effects.law || !effects.law->follows_state() || !past.exists())
      return missed;
    const CellReader<dim> reader = this->reader(t0, past);
    missed.reserve(tissue.cells().size());
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        const bool             grows =
          (effects.grows.empty() || effects.grows[cell.type()]) &&
          !(effects.death && effects.death->is_dead(cell.cell()));
        missed.push_back(grows ? effects.law->missed(growing(cell, t0)) : 0.);
      }
    return missed;
  }

  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::absorb(const Tensor<2, dim>        &D,
                               const Tensor<2, dim>        &F_g,
                               const CellView<dim, double> &after) const
  {
    // F_g = K F_r becomes D K F_r = K (K⁻¹ D K F_r).
    if (effects.cycle)
      {
        CycleState<dim>      state = clock(after);
        const Tensor<2, dim> K     = F_g * invert(state.growth_pre);
        state.growth_pre           = invert(K) * D * F_g;
        set_clock(after, state);
      }
    else
      {
        const Tensor<2, dim> K = F_g * invert(after.get(effects.relaxed));
        after.set(effects.relaxed, invert(K) * D * F_g);
      }
    return D * F_g;
  }

  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
