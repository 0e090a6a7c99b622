// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>
#include <morula/effects/fate/random.h>

// What cells are made to be, and the parts of F_g and their product,
// doc/theory.md (8.7): F_g = F_a F_law F_cycle F_r.

namespace Morula
{
  template <int dim>
  CellDevelopment<dim>::CellDevelopment(DevelopmentEffects<dim>  effects,
                                        const CellColumns<dim>  &columns,
                                        const StateColumns<dim> &state,
                                        const TissueMaterial    &material,
                                        const std::uint64_t      random_seed)
    : effects(std::move(effects))
    , columns_(columns)
    , state_(state)
    , material(material)
    , random_seed(random_seed)
  {
    // Rows are kept from of_step() to commit() where an effect besides the cell
    // cycle has columns of its own, an expression reads the state, or tissue
    // flows. Otherwise a row costs more memory than its second computation
    // costs time.
    const auto &with_state = this->effects.with_state;
    keeps_rows             = std::any_of(with_state.begin(),
                             with_state.end(),
                             [this](const Effect<dim> *effect) {
                               return effect != this->effects.proliferation;
                             }) ||
                 state_.any_in_use() || !this->effects.flows.empty();
    announces_growth = this->effects.law && divides() &&
                       this->effects.fates.dividing->follows_growth();
  }


  template <int dim>
  CellDevelopment<dim>::CellDevelopment(
    std::unique_ptr<const GrowthLaw<dim>>    law,
    std::optional<CellCycle<dim>>            cycle,
    std::unique_ptr<const DivisionRule<dim>> rule)
    : CellDevelopment(DevelopmentEffects<dim>(),
                      CellColumns<dim>(),
                      StateColumns<dim>(),
                      TissueMaterial(MaterialParameters()),
                      0)
  {
    // This constructor is for tests and small programs: it has no types of
    // cells, no deaths and no expressions of the state, and the seed of the
    // cycle is its own.
    if (law)
      columns_.need_growth();
    effects.law = std::move(law);
    if (!cycle)
      return;
    auto proliferation =
      std::make_unique<Proliferation<dim>>(std::move(*cycle), columns_, 0);
    typename DivisionAxes<dim>::Rules rules;
    if (rule)
      rules.push_back(std::move(rule));
    proliferation->axes = std::make_shared<const DivisionAxes<dim>>(
      DivisionParameters(), state_, 0, std::move(rules));
    effects.with_state.push_back(proliferation.get());
    effects.add_fate(std::move(proliferation));
  }


  template <int dim>
  CellReader<dim>
  CellDevelopment<dim>::reader(const double t, const PastStep &past) const
  {
    // The reader has all that an expression may ask for besides the cell
    // itself. It has no clock without a cell cycle; then every cell counts as
    // its own founder.
    return {state_, material, effects.proliferation, random_seed, t, past};
  }


  template <int dim>
  bool
  CellDevelopment<dim>::is_held(const PresentCell<dim> &cell,
                                const double            t) const
  {
    // Of most cells the phase is all that is read.
    return has_checkpoint() && effects.proliferation->is_waiting(cell.cell()) &&
           cycle()->is_held(clock(cell.cell()),
                            CellAt<dim>(cell, t),
                            t,
                            cell.cell().elastic_volume_ratio());
  }


  template <int dim>
  void
  CellDevelopment<dim>::initialize(const types::particle_index  id,
                                   const CellView<dim, double> &cell,
                                   const double                 step,
                                   const GivenState            &given) const
  {
    // The order follows who reads what. The type comes first, as most
    // expressions depend on it, and the lineage key, which is behind the noise;
    // then what effects keep, as the numbers of cells, and the cycle, which may
    // read them. At last, if a step is given, each effect evaluates its
    // expressions once, so that an error is reported before the run begins.
    const CellReader<dim> reader = this->reader(0.);
    const Point<dim>      X      = cell.founder_position();
    if (effects.types)
      cell.set(state_.type, given.type ? *given.type : effects.founder_type(X));
    if (columns_.lineage_key.exists())
      cell.set(columns_.lineage_key, Random::founder_key(random_seed, id));
    const PresentCell<dim> founder(cell, id, X, reader);
    for (const Effect<dim> *effect : effects.with_state)
      effect->begin(founder, cell);
    if (effects.proliferation)
      effects.proliferation->found(founder, cell, step, given.phase);
    // Without a step only the row is wanted, for example for an estimate.
    if (!(step > 0.))
      return;
    const PresentCell<dim> whole(cell, id, X, reader);
    for (const auto &[expression, n_components] : state_.expressions())
      for (unsigned int c = 0; c < n_components; ++c)
        whole.value(expression, 0.5 * step, c);
    for (const auto &fate : effects.fates.list)
      fate->check_cell(founder, step);
    if (effects.law)
      effects.law->check_cell(founder, step);
    for (const auto &factor : effects.factors)
      factor->check_cell(founder, step);
    for (const auto &flow : effects.flows)
      flow->check_cell(founder, step);
  }


  template <int dim>
  void
  CellDevelopment<dim>::commit(Tissue<dim>                  &tissue,
                               const DevelopmentOfStep<dim> &of_step,
                               const double                  t0,
                               const double                  t1) const
  {
    // The equilibrium has converged, so the rows of t1 replace those of t0. F
    // is not touched here: the motion of the step updates it afterwards. Rows
    // that were not kept are computed again from the same committed state and
    // the same times, and so come out the same to the last bit.
    if (!grows() && !keeps_rows)
      return;
    const CellReader<dim>  reader = this->reader(t0, of_step.past);
    std::vector<double>    row;
    std::vector<CellEvent> events; // not read: of_step has them already
    Errors                 errors;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const CellView<dim, double> cell = tissue.cell(p);
        if (keeps_rows)
          {
            const auto kept =
              of_step.rows.begin() + std::size_t(p) * columns_.n_numbers();
            std::copy(kept, kept + columns_.n_numbers(), cell.row().begin());
            continue;
          }
        // The row was not kept, as computing it again is cheap.
        row.assign(cell.row().begin(), cell.row().end());
        develop(present_cell(tissue, p, reader),
                CellView<dim, double>(make_array_view(row), columns_),
                t0,
                t1,
                nullptr,
                events,
                errors);
        std::copy(row.begin(), row.end(), cell.row().begin());
      }
  }


  template <int dim>
  unsigned int
  CellDevelopment<dim>::make_daughter(const CellView<dim, double> &daughter,
                                      const types::particle_index  id,
                                      const Point<dim>            &position,
                                      const unsigned int           which,
                                      const double                 birth,
                                      const double                 t1,
                                      std::vector<CellEvent>      &events) const
  {
    // A daughter begins as a copy of her mother. First she gets what is hers by
    // birth, then she lives through the rest of the step, from her birth to t1,
    // in which she may change her type or die. The type that is returned is the
    // one she is born with, since the later change is an event of its own.
    if (state_.birth_time.exists())
      daughter.set(state_.birth_time, birth);
    const std::uint64_t mother =
      columns_.lineage_key.exists() ? daughter.get(columns_.lineage_key) : 0;
    for (const auto &fate : effects.fates.list)
      fate->inherit(daughter, state_, which, birth);
    const unsigned int own =
      state_.type.exists() ? daughter.get(state_.type) : 0;
    const CellReader<dim>  reader = this->reader(t1);
    const PresentCell<dim> cell(daughter, id, position, reader);
    for (const Effect<dim> *effect : effects.with_state)
      effect->born(cell, daughter, mother, which, birth, t1);
    // Where the clock is the only fate there is nothing more to do now: it has
    // exact times, so the next step finds what happened since the birth.
    if (!effects.proliferation || effects.fates.list.size() > 1)
      effects.fates.live(cell, daughter, birth, t1, events);
    return own;
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
                             Errors                      &errors) const
  {
    // Flows act one after the other on what is left of the elastic part. Each
    // has a share that step_error uses to weigh what the flow's forecast
    // missed; a share is pushed for every flow, whether it acts or not, since
    // missed_flow() reads them by cell and number of the flow.
    errors.flow_shares.clear();
    Tensor<2, dim> at_t0 = before.cell().growth();
    for (const auto &flow : effects.flows)
      {
        const FlowOfStep<dim> of_step =
          flow->flow(before, after, at_t0, F_g, t0, t1);
        if (of_step.D)
          F_g = absorb(*of_step.D, F_g, after);
        // What a cell gives up at once it does not have at t0 either, so that
        // the next flow must not weigh it in.
        if (of_step.at_once)
          at_t0 = *of_step.D * at_t0;
        errors.flow_shares.push_back(of_step.share);
        errors.relaxed.exponent += of_step.exponent;
        errors.relaxed.kept *= of_step.kept;
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
  CellDevelopment<dim>::refer_anew(Tissue<dim> &tissue) const
  {
    // Tissue that flows for generations shears F and F_g without end, though
    // F_e stays small. The right factor of both is taken off, which has a
    // determinant of 1: F_r takes it in, and all that is kept of the reference
    // configuration goes along. Contraction, law and cycle do not see it, nor
    // do F_e, W and V.
    constexpr double longest = 1e6; // the squared norm over that of a ball
    if (!effects.proliferation && !effects.relaxed.exists())
      return;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const CellView<dim, double> cell = tissue.cell(p);
        const Tensor<2, dim>        F_g = cell.growth(), F = cell.F();
        const double                g = std::pow(determinant(F_g), 1. / dim);
        if (F_g.norm_square() < longest * g * g)
          continue;
        const Tensor<2, dim> F_e       = F * invert(F_g);
        const bool           has_shape = columns_.shape.exists();
        const Tensor<2, dim> shape =
          has_shape ? cell.shape() : Tensor<2, dim>();
        cell.set(columns_.growth, absorb(g * invert(F_g), F_g, cell));
        cell.set(columns_.deformation, g * F_e);
        if (has_shape)
          cell.set(columns_.shape,
                   invert(cell.unrelaxed_deformation()) * shape);
        if (state_.surface_normal.exists())
          cell.set(state_.surface_normal,
                   transpose(g * invert(F_g)) *
                     cell.get(state_.surface_normal));
      }
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
    // Shares lie cell by cell, with one number for each flow; there are none
    // where nothing flows in the step. The sum is this cell's contribution to
    // doc/theory.md (5.10).
    const std::size_t n =
      of_step.flow_shares.empty() ? 0 : effects.flows.size();
    double missed = 0.;
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


  template struct DevelopmentEffects<2>;
  template struct DevelopmentEffects<3>;
  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
