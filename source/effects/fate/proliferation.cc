// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/proliferation.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>

#include <limits>
#include <utility>

namespace Morula
{
  template <int dim>
  Proliferation<dim>::Proliferation(const Parameters         &parameters,
                                    const EffectSetting<dim> &setting)
    : Proliferation(CellCycle<dim>(parameters,
                                   setting.random_seed,
                                   setting.slack,
                                   setting.state),
                    setting.columns,
                    setting.random_seed)
  {
    this->parameters = parameters;
  }


  template <int dim>
  Proliferation<dim>::Proliferation(CellCycle<dim>      cycle,
                                    CellColumns<dim>   &columns,
                                    const std::uint64_t seed)
    : cycle_(std::move(cycle))
    , columns_(columns,
               cycle_.has_own_duration(),
               cycle_.has_own_hazard(),
               cycle_.keeps_exit_rate(),
               cycle_.has_checkpoint())
    , random_seed(seed)
  {}


  template <int dim>
  void
  Proliferation<dim>::check(const Preview<dim> &scene) const
  {
    DividingFate<dim>::check(scene);
    cycle_.check(scene.founders, scene.keys.time.step);
  }


  template <int dim>
  void
  Proliferation<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    DividingFate<dim>::review(scene, review);
    if (parameters)
      review_cell_cycle(*parameters, scene, review);
  }


  template <int dim>
  void
  Proliferation<dim>::set_clock(const CellView<dim, double> &cell,
                                const CycleState<dim>       &state) const
  {
    columns_.store(state, cell);
  }


  template <int dim>
  void
  Proliferation<dim>::found(const PresentCell<dim>            &founder,
                            const CellView<dim, double>       &row,
                            const double                       step,
                            const std::optional<unsigned int> &phase) const
  {
    // The order follows who reads what. The key is stored first; then the clock
    // is made, with a phase if the file has one; then the axis of a cell that
    // is already growing, as a rule may read the state. At last the growth
    // before the cycle is set, which needs the axis.

    // The noise that expressions read follows from this key.
    CycleState<dim> state;
    state.key = Random::founder_key(random_seed, founder.id());
    set_clock(row, state);
    const CellAt<dim> at(founder, 0.);
    if (step > 0.)
      cycle_.check_cell(at, step);
    state = phase ? cycle_.founder_in_phase(founder.id(), at, *phase) :
                    cycle_.founder(founder.id(), at);
    choose_axis(CycleState<dim>(), founder, 0., state);
    if (phase)
      cycle_.begin_growth(state, at);
    set_clock(row, state);
  }


  template <int dim>
  void
  Proliferation<dim>::choose_first_axis(const PresentCell<dim>      &founder,
                                        const CellView<dim, double> &row) const
  {
    // Founders get their axis before the steady fields are known. It is chosen
    // again when they are, from the same random direction.
    CycleState<dim> state = clock(row);
    if (this->rule(founder.type()) == nullptr ||
        state.phase != CyclePhase::growing)
      return;
    state.axis = Random::direction<dim>(random_seed, state.key);
    choose_axis(CycleState<dim>(), founder, 0., state);
    set_clock(row, state);
  }


  template <int dim>
  void
  Proliferation<dim>::absorb(const Tensor<2, dim>        &D,
                             const Tensor<2, dim>        &F_g,
                             const CellView<dim, double> &row) const
  {
    // F_g = K F_r becomes D K F_r = K (K⁻¹ D K F_r), doc/theory.md (8.7). F_r
    // is a factor of the growth before the cycle, so the running cycle is part
    // of K.
    CycleState<dim>      state = clock(row);
    const Tensor<2, dim> K     = F_g * invert(state.growth_pre);
    state.growth_pre           = invert(K) * D * F_g;
    set_clock(row, state);
  }


  template <int dim>
  Tensor<1, dim>
  Proliferation<dim>::placement_axis(const CellView<dim, const double> &cell,
                                     const unsigned int type) const
  {
    // An axis that was chosen in the reference configuration is placed as the
    // cycle says. One that named a present direction is carried to the present
    // configuration.
    const CycleState<dim>          state = clock(cell);
    const DivisionRule<dim> *const rule  = this->rule(type);
    // The running cycle stretches n_s along itself, so what is behind it in F_g
    // is taken off and the direction is F F_pre⁻¹ n_s.
    if (rule != nullptr && rule->frame() == AxisFrame::present)
      return this->axes->placement(cell,
                                   invert(state.growth_pre) * state.axis,
                                   type);
    return this->axes && this->axes->follow_rotation() ?
             this->axes->placement(cell, state.axis, type) :
             state.axis;
  }


  template <int dim>
  double
  Proliferation<dim>::time_of_division(const CellView<dim, const double> &cell,
                                       const double t) const
  {
    const CycleState<dim> state = clock(cell);
    const CellAt<dim>     at(cell.founder_position());
    return cycle_.divides(state, at, t) ?
             cycle_.division_time(state, at) :
             std::numeric_limits<double>::infinity();
  }


  template <int dim>
  void
  Proliferation<dim>::inherit(const CellView<dim, double> &daughter,
                              const StateColumns<dim>     &columns,
                              const unsigned int           which,
                              const double) const
  {
    // The clock in the row is still the mother's, and so is the type: this fate
    // is the first, and that of types the last. Both daughters go on with the
    // mother's cycle, but each gets a random key of its own from hers.
    this->halve(daughter, columns);
    const auto [minus, plus] = cycle_.daughters(clock(daughter));
    set_clock(daughter, which == 0 ? minus : plus);
  }


  template <int dim>
  void
  Proliferation<dim>::make_good(const PresentCell<dim>      &before,
                                const CellView<dim, double> &row) const
  {
    const PastStep &past = before.reader().past;
    if (!past.exists() || !cycle_.keeps_exit_rate())
      return;
    CycleState<dim> state = clock(row);
    cycle_.make_good(state, CellAt<dim>(before, past.middle()), past);
    set_clock(row, state);
  }


  template <int dim>
  CycleState<dim>
  Proliferation<dim>::run_clock(const PresentCell<dim>      &cell,
                                const CellView<dim, double> &row,
                                const Stretch               &stretch) const
  {
    const CycleState<dim> state =
      next_clock(cell, clock(row), stretch.begin, stretch.end);
    set_clock(row, state);
    return state;
  }


  template <int dim>
  std::optional<double>
  Proliferation<dim>::next(const PresentCell<dim>      &cell,
                           const CellView<dim, double> &row,
                           const Stretch               &stretch) const
  {
    // Division is not carried out here. Its time says when the cell's own life
    // ends in this step; the daughters are made after the equilibrium.
    const CycleState<dim> state = run_clock(cell, row, stretch);
    const CellAt<dim>     at(cell, stretch.begin);
    if (!cycle_.divides(state, at, stretch.end))
      return {};
    return std::min(stretch.end, cycle_.division_time(state, at));
  }


  template <int dim>
  void
  Proliferation<dim>::pass(const PresentCell<dim>      &cell,
                           const CellView<dim, double> &row,
                           const Stretch               &stretch,
                           const double                 s) const
  {
    // The clock of the round's beginning is in `cell`; it is run again, only to
    // the time of the other fate's event.
    set_clock(row, next_clock(cell, clock(cell.cell()), stretch.begin, s));
  }


  template <int dim>
  void
  Proliferation<dim>::expect(const PresentCell<dim>      &before,
                             const CellView<dim, double> &row,
                             const double                 t,
                             const bool                   is_whole) const
  {
    // A rate is expected only of a cell that waited at both ends of the step:
    // otherwise the wait began or ended in it, and the integral is of another
    // time.
    if (!cycle_.keeps_exit_rate())
      return;
    CycleState<dim> state = clock(row);
    const bool      waits =
      clock(before.cell()).is_drawn_by_hazard() && state.is_drawn_by_hazard();
    state.exit_rate = is_whole && waits ?
                        cycle_.exit_rate_at(CellAt<dim>(before, t)) :
                        not_expected;
    set_clock(row, state);
  }


  template <int dim>
  void
  Proliferation<dim>::end_of_life(const PresentCell<dim>      &cell,
                                  const CellView<dim, double> &row,
                                  const double                 s) const
  {
    // A dead cell keeps the size that it has, half-way through its cycle or
    // not, and never divides.
    CycleState<dim> state = clock(row);
    state.growth_pre      = cycle_.growth(state, CellAt<dim>(cell, s), s);
    state.phase           = CyclePhase::never;
    set_clock(row, state);
  }


  template <int dim>
  void
  Proliferation<dim>::advance(const PresentCell<dim>      &before,
                              const CellView<dim, double> &after,
                              const double,
                              const double) const
  {
    columns_.remember_size(before.cell(), after);
  }


  template <int dim>
  void
  Proliferation<dim>::check_cell(const PresentCell<dim> &founder,
                                 const double            step) const
  {
    if (clock(founder.cell()).phase == CyclePhase::never)
      return;
    if (this->axes)
      this->axes->draw(founder, 0., 0);
    if (const DivisionRule<dim> *const rule = this->rule(founder.type()))
      rule->check_cell(founder, step);
  }


  template <int dim>
  CycleState<dim>
  Proliferation<dim>::next_clock(const PresentCell<dim> &cell,
                                 const CycleState<dim>  &before,
                                 const double            t0,
                                 const double            t1) const
  {
    CycleState<dim> after =
      cycle_.advance(before,
                     CellAt<dim>(cell, t0),
                     t0,
                     t1,
                     columns_.size(cell.cell(), cell.reader().past));
    choose_axis(before, cell, t0, after);
    return after;
  }


  template <int dim>
  void
  Proliferation<dim>::choose_axis(const CycleState<dim>  &before,
                                  const PresentCell<dim> &cell,
                                  const double            t,
                                  CycleState<dim>        &after) const
  {
    // A rule is asked once, at the onset of S, or for a founder that is on its
    // way. It gives the mean direction; then the spread is drawn around it,
    // doc/theory.md (6.3d). Rules that speak of the present configuration are
    // followed by the pull-back to n_s. Without a rule the random axis of the
    // clock stays.
    const bool begins =
      before.phase != CyclePhase::growing && after.phase == CyclePhase::growing;
    // This is a founder whose file says that it is in G1.
    const bool has_begun =
      before.phase == CyclePhase::never && after.phase == CyclePhase::divided;
    const DivisionRule<dim> *const rule = this->rule(cell.type());
    if (rule == nullptr || !(begins || has_begun))
      return;
    const CellView<dim, const double> &view = cell.cell();
    Tensor<1, dim>                     axis =
      axis_by_rule(*rule,
                   cell,
                   t,
                   after.axis,
                   this->axes->draw(cell,
                                    t,
                                    has_begun ?
                                      Random::past_key(random_seed, after.key) :
                                      after.key));
    // A present direction is pulled back through all growth but the cycle's,
    // doc/theory.md (6.3e), since the cycle's stretch acts before that.
    if (rule->frame() == AxisFrame::present)
      {
        Tensor<2, dim>        F_g   = view.growth();
        const CycleState<dim> state = clock(view);
        if (state.phase != CyclePhase::never)
          F_g = F_g * invert(cycle_.growth(state, view.founder_position(), t));
        axis = invert(view.elastic_deformation() * F_g) * axis;
      }
    after.axis = axis / axis.norm();
  }


  template class Proliferation<2>;
  template class Proliferation<3>;
} // namespace Morula
