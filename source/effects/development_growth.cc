// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>

// This file makes the parts of F_g and their product, doc/theory.md (8.7):
// F_g = F_a F_law F_cycle F_r.

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
    // This is F_cycle F_r, all that stands to the right of the law's factor.
    // Where there is a cell cycle it keeps F_r within its own growth before the
    // cycle.
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
    // A law is told its own factor of t0 only, as it does not know the others.
    // With contraction the factor has a column, because F_a does not commute
    // with it; else it is what is left of F_g when the factors behind it are
    // taken off.
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
  void
  CellDevelopment<dim>::announce_growth(const PresentCell<dim>      &before,
                                        const CellView<dim, double> &after,
                                        const double                 t0,
                                        const double                 t1) const
  {
    // What befalls the cell in the step does not change its growth, but for a
    // death, which ends it. So the ratio of the whole step is known before any
    // event is. Factors besides the law count at the beginning of a step only.
    double ratio = 1.;
    if (grows_by_law(before))
      {
        const GrowingCell<dim> growing = this->growing(before, t0);
        ratio = determinant(effects.law->growth(growing, t0, t1)) /
                determinant(growing.growth);
      }
    effects.fates.dividing->grow(before, after, ratio, {t0, t1});
  }


  template <int dim>
  Tensor<2, dim>
  CellDevelopment<dim>::living_growth(const PresentCell<dim>      &before,
                                      const CellView<dim, double> &after,
                                      const double                 t0,
                                      const double                 t1,
                                      double                      &missed) const
  {
    // The product is built from right to left: the cycle and what has relaxed,
    // then the law, then the active factors such as contraction. All factors
    // are those of t1, or of the death of a cell that dies earlier; they are
    // functions of the state of t0, so a failed step leaves nothing to undo.
    Tensor<2, dim> F_g = growth_behind_law(after, t1);
    if (effects.law)
      {
        const GrowingCell<dim> growing = this->growing(before, t0);
        GrowthOfStep<dim>      of_law{growing.growth};
        if (grows_by_law(before))
          of_law = effects.law->grow(growing, t0, t1, after);
        else
          // A type that does not grow keeps F_law, but the law goes on
          // observing the cell: otherwise its memory would be of an older step
          // when the cell changes its type.
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
    // Flows act one after the other on what is left of the elastic part. Each
    // has a share that step_error uses to weigh what the flow's forecast
    // missed; a share is pushed for every flow, whether it acts or not, since
    // missed_flow() reads them by cell and number of the flow.
    shares.clear();
    Tensor<2, dim> at_t0 = before.cell().growth();
    for (const auto &flow : effects.flows)
      {
        const FlowOfStep<dim> of_step =
          flow->flow(before, after, at_t0, F_g, t0, t1);
        if (of_step.D)
          F_g = absorb(*of_step.D, F_g, after);
        // A cell that forgets its stress has no elastic part of t0 any more, so
        // the next flow must not weigh it in.
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
    // F_g becomes D F_g, and the change is booked on the rightmost factor F_r,
    // doc/theory.md (8.7). Then the cell goes on growing along its axes in the
    // new configuration that is free of stress.
    if (effects.proliferation)
      effects.proliferation->absorb(D, F_g, after);
    else
      {
        // F_g = K F_r becomes D K F_r = K (K⁻¹ D K F_r), so that K, which other
        // effects compute, stays as it is.
        const Tensor<2, dim> K = F_g * invert(after.get(effects.relaxed));
        after.set(effects.relaxed, invert(K) * D * F_g);
      }
    return D * F_g;
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
    // Shares lie cell by cell, with one number for each flow. The sum is this
    // cell's contribution to doc/theory.md (5.10).
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
    // The loop is over the cells of this rank in the order of the store. The
    // numbers are what step_error weighs with the cells' volumes, doc/theory.md
    // (5.10). In the first step nothing is known, so the list is empty.
    std::vector<double> missed;
    if (!effects.law_follows_state() || !past.exists())
      return missed;
    const CellReader<dim> reader = this->reader(t0, past);
    missed.reserve(tissue.cells().size());
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        const bool             grows =
          grows_by_law(cell) && !effects.fates.is_dead(cell.cell());
        missed.push_back(grows ? effects.law->missed(growing(cell, t0)) : 0.);
      }
    return missed;
  }


  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
