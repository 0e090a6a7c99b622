// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>
#include <morula/effects/fate/random.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  template <int dim>
  const DivisionRule<dim> *
  DevelopmentEffects<dim>::rule(const unsigned int type) const
  {
    if (!rule_of_type.empty())
      return rule_of_type[type];
    return rules.empty() ? nullptr : rules.front().get();
  }

  template <int dim>
  bool
  DevelopmentEffects<dim>::states_error() const
  {
    return relaxation || (law && law->follows_state());
  }

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
    keeps_rows = !this->effects.with_state.empty() || state_.any_in_use() ||
                 this->effects.contraction || this->effects.relaxation ||
                 this->effects.death;
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
    if (law)
      columns_.need_growth();
    if (cycle)
      effects.clock.emplace(columns_,
                            cycle->has_own_duration(),
                            cycle->has_own_hazard(),
                            cycle->keeps_exit_rate(),
                            cycle->has_checkpoint());
    effects.law   = std::move(law);
    effects.cycle = std::move(cycle);
    if (rule)
      effects.rules.push_back(std::move(rule));
  }

  template <int dim>
  bool
  CellDevelopment<dim>::grows() const
  {
    return effects.law || effects.cycle || effects.contraction ||
           effects.relaxation || effects.forgets_stress || effects.death;
  }

  template <int dim>
  bool
  CellDevelopment<dim>::present() const
  {
    return grows() || keeps_rows;
  }

  template <int dim>
  const CellCycle<dim> *
  CellDevelopment<dim>::cycle() const
  {
    return effects.cycle ? &*effects.cycle : nullptr;
  }

  template <int dim>
  const CellColumns<dim> &
  CellDevelopment<dim>::columns() const
  {
    return columns_;
  }

  template <int dim>
  const StateColumns<dim> &
  CellDevelopment<dim>::state() const
  {
    return state_;
  }

  template <int dim>
  const Death<dim> *
  CellDevelopment<dim>::death() const
  {
    return effects.death ? &*effects.death : nullptr;
  }

  template <int dim>
  CellReader<dim>
  CellDevelopment<dim>::reader(const double t, const PastStep &past) const
  {
    return {state_,
            material,
            effects.clock ? &*effects.clock : nullptr,
            cycle(),
            random_seed,
            t,
            past};
  }

  template <int dim>
  CycleState<dim>
  CellDevelopment<dim>::clock(const CellView<dim, const double> &cell) const
  {
    return effects.clock->load(cell);
  }

  template <int dim>
  void
  CellDevelopment<dim>::set_clock(const CellView<dim, double> &cell,
                                  const CycleState<dim>       &state) const
  {
    effects.clock->store(state, cell);
  }

  template <int dim>
  void
  CellDevelopment<dim>::initialize(const types::particle_index  id,
                                   const CellView<dim, double> &cell,
                                   const double                 step,
                                   const GivenState            &given) const
  {
    const CellReader<dim> reader = this->reader(0.);
    const Point<dim>      X      = cell.founder_position();
    if (effects.types)
      cell.set(state_.type,
               given.type ? *given.type : effects.types->founder_type(X));
    const PresentCell<dim> founder(cell, id, X, reader);
    if (effects.cycle)
      {
        // The key first: it is behind the noise.
        CycleState<dim> state;
        state.key = Random::founder_key(random_seed, id);
        set_clock(cell, state);
        const CellAt<dim> at(founder, 0.);
        if (step > 0.)
          effects.cycle->check_cell(at, step);
        state = given.phase ?
                  effects.cycle->founder_in_phase(id, at, *given.phase) :
                  effects.cycle->founder(id, at);
        choose_axis(CycleState<dim>(), founder, 0., state);
        if (given.phase)
          effects.cycle->begin_growth(state, at);
        set_clock(cell, state);
      }
    for (const Effect<dim> *effect : effects.with_state)
      effect->begin(cell);
    if (step > 0.)
      {
        if (effects.types)
          effects.types->check_cell(founder);
        if (effects.death)
          effects.death->check_cell(founder, step);
        if (effects.law)
          effects.law->check_cell(founder, step);
        const DivisionRule<dim> *const rule = effects.rule(founder.type());
        if (rule != nullptr && clock(cell).phase != CyclePhase::never)
          rule->check_cell(founder, step);
        if (effects.contraction)
          effects.contraction->check_cell(founder, step);
        if (effects.relaxation)
          effects.relaxation->check_cell(founder, step);
      }
  }

  template <int dim>
  CycleState<dim>
  CellDevelopment<dim>::next_clock(const PresentCell<dim> &cell,
                                   const CycleState<dim>  &before,
                                   const double            t0,
                                   const double            t1) const
  {
    const CellView<dim, const double> &view = cell.cell();
    CycleState<dim>                    after =
      effects.cycle->advance(before,
                             CellAt<dim>(cell, t0),
                             t0,
                             t1,
                             effects.clock->size(view, cell.reader().past));
    choose_axis(before, cell, t0, after);
    return after;
  }

  template <int dim>
  void
  CellDevelopment<dim>::choose_axis(const CycleState<dim>  &before,
                                    const PresentCell<dim> &cell,
                                    const double            t,
                                    CycleState<dim>        &after) const
  {
    const bool begins =
      before.phase != CyclePhase::growing && after.phase == CyclePhase::growing;
    // a founder whose file says that it is in G1
    const bool has_begun =
      before.phase == CyclePhase::never && after.phase == CyclePhase::divided;
    const DivisionRule<dim> *const rule = effects.rule(cell.type());
    if (rule == nullptr || !(begins || has_begun))
      return;
    const CellView<dim, const double> &view = cell.cell();
    Tensor<1, dim>                     axis =
      rule->axis({view.founder_position(),
                  view.elastic_deformation(),
                  after.axis,
                  &cell,
                  t,
                  effects.cycle->least_anisotropy(cell, t)});
    const double spread = effects.cycle->axis_spread(cell, t);
    if (spread > 0.)
      axis = Random::direction_around(axis / axis.norm(),
                                      spread,
                                      random_seed,
                                      has_begun ? Random::past_key(random_seed,
                                                                   after.key) :
                                                  after.key);
    // doc/theory.md (6.3e)
    if (rule->frame() == AxisFrame::present)
      axis =
        invert(view.elastic_deformation() * growth_left_of_cycle(view, t)) *
        axis;
    after.axis = axis / axis.norm();
  }

  template <int dim>
  void
  CellDevelopment<dim>::choose_first_axis(
    const PresentCell<dim> &founder, const CellView<dim, double> &cell) const
  {
    if (!effects.cycle || effects.rule(founder.type()) == nullptr)
      return;
    CycleState<dim> state = clock(cell);
    if (state.phase != CyclePhase::growing)
      return;
    state.axis = Random::direction<dim>(random_seed, state.key);
    choose_axis(CycleState<dim>(), founder, 0., state);
    set_clock(cell, state);
  }

  template <int dim>
  void
  CellDevelopment<dim>::make_good(const PresentCell<dim>      &before,
                                  const CellView<dim, double> &after) const
  {
    const PastStep &past = before.reader().past;
    if (!past.exists())
      return;
    if (effects.death)
      effects.death->make_good(before, after);
    if (effects.types)
      effects.types->make_good(before, after);
    if (effects.cycle && effects.cycle->keeps_exit_rate())
      {
        CycleState<dim> state = clock(after);
        effects.cycle->make_good(state,
                                 CellAt<dim>(before, past.middle()),
                                 past);
        set_clock(after, state);
      }
  }

  template <int dim>
  void
  CellDevelopment<dim>::expect_rates(const PresentCell<dim>      &before,
                                     const CellView<dim, double> &after,
                                     const double                 t0,
                                     const double                 t1,
                                     const bool is_whole) const
  {
    const double middle = 0.5 * (t0 + t1);
    if (effects.death)
      effects.death->expect_rate(before, after, middle, is_whole);
    if (effects.types)
      effects.types->expect_rates(before, after, middle, is_whole);
    if (effects.cycle && effects.cycle->keeps_exit_rate())
      {
        CycleState<dim> state = clock(after);
        const bool      waits = clock(before.cell()).is_drawn_by_hazard() &&
                           state.is_drawn_by_hazard();
        state.exit_rate =
          is_whole && waits ?
            effects.cycle->exit_rate_at(CellAt<dim>(before, middle)) :
            not_expected;
        set_clock(after, state);
      }
  }

  template <int dim>
  typename CellDevelopment<dim>::Errors
  CellDevelopment<dim>::develop(const PresentCell<dim>      &before,
                                const CellView<dim, double> &after,
                                const double                 t0,
                                const double                 t1,
                                std::vector<CellEvent>      &events) const
  {
    const bool dead = is_dead_at(t0, before, after, events);
    if (!dead)
      {
        const std::size_t n_events = events.size();
        make_good(before, after);
        const CycleState<dim> next = advance(before, after, t0, t1, events);
        if (effects.cycle)
          set_clock(after, next);
        expect_rates(before, after, t0, t1, events.size() == n_events);
      }
    if (effects.clock)
      effects.clock->remember_size(before.cell(), after);
    for (const Effect<dim> *effect : effects.with_state)
      effect->advance(before, after, t0, t1);
    Errors errors;
    if (!grows())
      return errors;
    const double end =
      effects.death ? std::min(t1, effects.death->time(after)) : t1;
    Tensor<2, dim> F_g =
      dead ? before.cell().growth() :
             living_growth(before,
                           after,
                           effects.cycle ? clock(after) : CycleState<dim>(),
                           t0,
                           end,
                           errors.missed_growth);
    if (effects.death && effects.death->is_dead(after))
      F_g *= effects.death->shrink(after, t1);
    if (effects.relaxation)
      F_g = relax(before, after, F_g, t0, t1, errors.flow_share);
    after.set(columns_.growth, F_g);
    return errors;
  }

  template <int dim>
  DevelopmentOfStep<dim>
  CellDevelopment<dim>::of_step(const Tissue<dim> &tissue,
                                const double       t0,
                                const double       t1,
                                const PastStep    &past) const
  {
    DevelopmentOfStep<dim> result;
    result.present = grows();
    result.past    = past;
    if (!present())
      return result;
    const Cells<dim>     &cells      = tissue.cells();
    const CellReader<dim> reader     = this->reader(t0, past);
    const CellReader<dim> after_step = this->reader(t1);
    if (keeps_rows)
      result.rows.reserve(cells.size() * columns_.n_numbers());
    if (grows())
      {
        result.previous.reserve(cells.size());
        result.current.reserve(cells.size());
      }
    std::vector<double> row;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const auto             cell = cells[p];
        const PresentCell<dim> before(cell,
                                      cells.id(p),
                                      cells.position(p),
                                      reader);
        if (grows())
          result.previous.push_back(cell.growth());
        if (!keeps_rows)
          {
            const CycleState<dim> next =
              effects.cycle ? next_clock(before, clock(cell), t0, t1) :
                              CycleState<dim>();
            result.current.push_back(growth(before, next, t0, t1));
            continue;
          }
        row.assign(cell.row().begin(), cell.row().end());
        const CellView<dim, double> after(make_array_view(row), columns_);
        const Errors errors = develop(before, after, t0, t1, result.events);
        if (effects.law && effects.law->follows_state())
          result.missed_growth.push_back(errors.missed_growth);
        if (effects.relaxation)
          result.flow_shares.push_back(errors.flow_share);
        if (grows())
          result.current.push_back(after.growth());
        if (material.depends_on_state())
          result.lame.push_back(
            PresentCell<dim>(after, cells.id(p), cells.position(p), after_step)
              .lame());
        result.rows.insert(result.rows.end(), row.begin(), row.end());
      }
    return result;
  }

  template <int dim>
  void
  CellDevelopment<dim>::commit(Tissue<dim>                  &tissue,
                               const DevelopmentOfStep<dim> &of_step,
                               const double                  t0,
                               const double                  t1) const
  {
    if (!present())
      return;
    const CellReader<dim> reader = this->reader(t0, of_step.past);
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const CellView<dim, double> cell = tissue.cell(p);
        if (keeps_rows)
          {
            const auto row =
              of_step.rows.begin() + std::size_t(p) * columns_.n_numbers();
            std::copy(row, row + columns_.n_numbers(), cell.row().begin());
            continue;
          }
        if (effects.cycle)
          {
            set_clock(cell,
                      next_clock(PresentCell<dim>(cell,
                                                  tissue.cells().id(p),
                                                  tissue.cells().position(p),
                                                  reader),
                                 clock(cell),
                                 t0,
                                 t1));
            effects.clock->remember_size(cell, cell);
          }
        cell.set(columns_.growth, of_step.current[p]);
      }
  }

  template <int dim>
  Tensor<1, dim>
  CellDevelopment<dim>::placement_axis(
    const CellView<dim, const double> &cell) const
  {
    const CycleState<dim>          state = clock(cell);
    const DivisionRule<dim> *const rule =
      effects.rule(state_.type.exists() ? cell.get(state_.type) : 0);
    if (rule == nullptr || rule->frame() == AxisFrame::reference)
      return effects.cycle->placement_axis(state, cell.elastic_deformation());
    // The running cycle stretches n_s along itself.
    const Tensor<1, dim> carried =
      cell.F() * (invert(state.growth_pre) * state.axis);
    return carried / carried.norm();
  }

  template struct DevelopmentEffects<2>;
  template struct DevelopmentEffects<3>;
  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
