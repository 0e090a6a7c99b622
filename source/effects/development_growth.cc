// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>

// The parts of F_g and their product: doc/theory.md (8.7).

namespace Morula
{
  template <int dim>
  bool
  CellDevelopment<dim>::grows_by_law(const PresentCell<dim> &cell) const
  {
    return effects.grows.empty() || effects.grows[cell.type()];
  }


  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::growth_behind_law(
    const CellView<dim, const double> &cell, const double t) const
  {
    if (effects.proliferation)
      return effects.proliferation->growth(cell, t);
    return effects.relaxed.exists() ?
             cell.get(effects.relaxed) :
             Tensor<2, dim>(unit_symmetric_tensor<dim>());
  }


  template <int dim>
  GrowingCell<dim>
  CellDevelopment<dim>::growing(const PresentCell<dim> &cell,
                                const double            t0) const
  {
    const CellView<dim, const double> &view  = cell.cell();
    Tensor<2, dim>                     at_t0 = view.growth();
    if (effects.law_growth.exists())
      at_t0 = view.get(effects.law_growth);
    else if (effects.proliferation || effects.relaxed.exists())
      at_t0 = at_t0 * invert(growth_behind_law(view, t0));
    return {
      view.founder_position(), at_t0, view.elastic_deformation(), &view, &cell};
  }


  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::living_growth(const PresentCell<dim>      &before,
                                      const CellView<dim, double> &after,
                                      const double                 t0,
                                      const double                 t1,
                                      double                      &missed) const
  {
    Tensor<2, dim> F_g = growth_behind_law(after, t1);
    if (effects.law)
      {
        const GrowingCell<dim> growing = this->growing(before, t0);
        GrowthOfStep<dim>      of_law{growing.growth};
        if (grows_by_law(before))
          of_law = effects.law->grow(growing, t0, t1, after);
        else
          effects.law->remember(growing, t0, t1, after);
        missed = of_law.missed;
        if (effects.law_growth.exists())
          after.set(effects.law_growth, of_law.growth);
        F_g = of_law.growth * F_g;
      }
    for (const auto &factor : effects.factors)
      F_g = factor->factor(before, after, t0, t1) * F_g;
    return F_g;
  }


  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::flow(const PresentCell<dim>      &before,
                             const CellView<dim, double> &after,
                             Tensor<2, dim>               F_g,
                             const double                 t0,
                             const double                 t1,
                             std::vector<double>         &shares) const
  {
    shares.clear();
    Tensor<2, dim> at_t0 = before.cell().growth();
    for (const auto &flow : effects.flows)
      {
        const FlowOfStep<dim> of_step =
          flow->flow(before, after, at_t0, F_g, t0, t1);
        if (of_step.D)
          F_g = absorb(*of_step.D, F_g, after);
        if (of_step.begins_anew)
          at_t0 = F_g;
        shares.push_back(of_step.share);
      }
    return F_g;
  }


  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::absorb(const Tensor<2, dim>        &D,
                               const Tensor<2, dim>        &F_g,
                               const CellView<dim, double> &after) const
  {
    if (effects.proliferation)
      effects.proliferation->absorb(D, F_g, after);
    else
      {
        // F_g = K F_r becomes D K F_r = K (K⁻¹ D K F_r).
        const Tensor<2, dim> K = F_g * invert(after.get(effects.relaxed));
        after.set(effects.relaxed, invert(K) * D * F_g);
      }
    return D * F_g;
  }


  template <int dim>
  double
  CellDevelopment<dim>::free_growth(std::vector<double>         row,
                                    const types::particle_index id,
                                    const double                end,
                                    const unsigned int          n_steps) const
  {
    // Free of stress F is F_g. The law takes the cell through equal steps; the
    // factors behind it are as they are at t = 0.
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
        const Tensor<2, dim>   of_law  = grows_by_law(before) ?
                                           effects.law->growth(growing, t0, t1) :
                                           growing.growth;
        effects.law->remember(growing, t0, t1, after);
        if (effects.law_growth.exists())
          after.set(effects.law_growth, of_law);
        const Tensor<2, dim> F_g = of_law * growth_behind_law(cell, t1);
        after.set(columns_.growth, F_g);
        after.set(columns_.deformation, F_g);
        row   = next;
        ratio = determinant(of_law);
      }
    return ratio;
  }


  template <int dim>
  bool
  CellDevelopment<dim>::states_error() const
  {
    return effects.states_error();
  }


  template <int dim>
  void
  CellDevelopment<dim>::remember_motion(const CellView<dim, double> &cell,
                                        const Tensor<2, dim>        &f) const
  {
    for (const auto &flow : effects.flows)
      flow->remember_motion(cell, f);
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
    const std::size_t n      = effects.flows.size();
    double            missed = 0.;
    for (std::size_t k = 0; k < n; ++k)
      missed +=
        of_step.flow_shares[p * n + k] *
        effects.flows[k]->error_of_forecast(cell, f, of_step.past, t1 - t0);
    return missed;
  }


  template <int dim>
  std::vector<double>
  CellDevelopment<dim>::missed_growth(const Tissue<dim> &tissue,
                                      const double       t0,
                                      const PastStep    &past) const
  {
    std::vector<double> missed;
    if (!effects.law_follows_state() || !past.exists())
      return missed;
    const CellReader<dim> reader = this->reader(t0, past);
    missed.reserve(tissue.cells().size());
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        const bool             grows =
          grows_by_law(cell) && !is_dead(effects.fates, cell.cell());
        missed.push_back(grows ? effects.law->missed(growing(cell, t0)) : 0.);
      }
    return missed;
  }


  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
