// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/proliferation.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>

#include <deal.II/base/mpi.h>

#include <cmath>

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
  {}


  template <int dim>
  Proliferation<dim>::Proliferation(CellCycle<dim>      cycle,
                                    CellColumns<dim>   &columns,
                                    const std::uint64_t seed)
    : cycle_(std::move(cycle))
    , random_seed(seed)
  {
    // The first five columns are always there. The others are numbers that only
    // some scenes need, so each is declared on its condition; clock() puts
    // a default in its place.
    columns.need_growth();
    columns.need_lineage();
    phase = columns.template add<CyclePhase>(
      {"phase", "", "where in the cycle, a CyclePhase", CyclePhase::never});
    event_time = columns.template add<double>(
      {"event_time", "day", "end of the G0 wait, or onset of S"});
    columns.need_lineage_key();
    lineage_key   = columns.lineage_key;
    division_axis = columns.template add<Tensor<1, dim>>(
      {"division_axis", "", "n_s of the running cycle"});
    growth_pre = columns.template add<Tensor<2, dim>>(
      {"growth_before_the_cycle",
       "",
       "F_g of the cycle before the onset of S",
       Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    if (cycle_.has_own_duration())
      duration = columns.template add<double>(
        {"cycle_duration", "day", "T of the running cycle"});
    if (cycle_.has_own_hazard())
      hazard = columns.template add<double>(
        {"wait_hazard", "", "rate of leaving G0, integrated over the wait"});
    if (cycle_.rate_of_exit().follows_state())
      {
        exit_rate = columns.template add<double>(
          {"wait_rate",
           "1/day",
           "rate of leaving G0 that the last step saw; -1: none",
           not_expected});
        // The clock integrates this hazard itself, while the cell waits and
        // only the integral tells for how long.
        const auto runs = [phase = phase, event_time = event_time](
                            const CellView<dim, const double> &cell) {
          return cell.get(phase) == CyclePhase::waiting &&
                 !std::isfinite(cell.get(event_time));
        };
        this->hazards_of_types[0].push_back(
          {cycle_.rate_of_exit(), hazard, exit_rate, {}, runs});
      }
    if (cycle_.has_checkpoint())
      J_e_before = columns.template add<double>(
        {"j_e_before", "", "J_e at the beginning of the step before", 1.});
  }


  template <int dim>
  void
  Proliferation<dim>::set_clock(const CellView<dim, double> &cell,
                                const CycleState<dim>       &state) const
  {
    // What has no column is the same for all cells, or is not used.
    cell.set(phase, state.phase);
    cell.set(event_time, state.event_time);
    cell.set(lineage_key, state.key);
    cell.set(division_axis, state.axis);
    cell.set(growth_pre, state.growth_pre);
    if (duration.exists())
      cell.set(duration, state.duration);
    if (hazard.exists())
      cell.set(hazard, state.hazard);
  }


  template <int dim>
  void
  Proliferation<dim>::check(const Preview<dim> &scene) const
  {
    cycle_.check(scene.founders, scene.keys.time.step);
  }


  template <int dim>
  void
  Proliferation<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    // The shortest cycle of all founders that proliferate is compared with the
    // step. A duration that depends on the state or the time is left to the
    // run.
    const double shortest =
      Utilities::MPI::min(cycle_.shortest(scene.founders), scene.comm);
    if (scene.keys.time.step > (0.25 + 1e-9) * shortest)
      review.warn(TimeParameters::step_path,
                  as_text(scene.keys.time.step) + " day",
                  "that is " + as_text(scene.keys.time.step / shortest) +
                    " of the shortest cell cycle, " + as_text(shortest) +
                    " day; we have tested steps up to a quarter "
                    "(doc/accuracy-and-cost.md, advice; doc/hard-cases.md, "
                    "showcase).",
                  "Shorten the step to 0.1 or 0.2 of the cycle.");
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
    if (rule != nullptr && rule->is_present())
      return this->axes->placement(cell,
                                   invert(state.growth_pre) * state.axis,
                                   type);
    return this->axes && this->axes->follow_rotation ?
             this->axes->placement(cell, state.axis, type) :
             state.axis;
  }


  template <int dim>
  void
  Proliferation<dim>::inherit(const CellView<dim, double> &daughter,
                              const StateColumns<dim> &,
                              const unsigned int which,
                              const double) const
  {
    // The clock in the row is still the mother's, and so is the type: this fate
    // is the first, and that of types the last. Both daughters go on with the
    // mother's cycle, but each gets a random key of its own from hers.
    const auto [minus, plus] = cycle_.daughters(clock(daughter));
    set_clock(daughter, which == 0 ? minus : plus);
  }


  template <int dim>
  void
  Proliferation<dim>::advance(const PresentCell<dim>      &before,
                              const CellView<dim, double> &after,
                              const double,
                              const double) const
  {
    if (J_e_before.exists())
      after.set(J_e_before, before.cell().elastic_volume_ratio());
  }


  template <int dim>
  CycleState<dim>
  Proliferation<dim>::next_clock(const PresentCell<dim> &cell,
                                 const CycleState<dim>  &before,
                                 const double            t0,
                                 const double            t1) const
  {
    // The slope of J_e is that of the last step, doc/theory.md (6.3g). In the
    // first step there is none, and J_e counts as constant.
    const PastStep &past = cell.reader().past;
    ElasticSize     size(cell.cell().elastic_volume_ratio());
    if (J_e_before.exists() && past.exists())
      size = {size.J_e,
              (size.J_e - cell.cell().get(J_e_before)) / past.length(),
              past.begin};
    CycleState<dim> after =
      cycle_.advance(before, CellAt<dim>(cell, t0), t0, t1, size);
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
      this->axes->direction(cell,
                            t,
                            after.axis,
                            has_begun ?
                              Random::past_key(random_seed, after.key) :
                              after.key);
    // A present direction is pulled back through all growth but the cycle's,
    // doc/theory.md (6.3e), since the cycle's stretch acts before that.
    if (rule->is_present())
      {
        Tensor<2, dim>        F_g   = view.growth();
        const CycleState<dim> state = clock(view);
        if (state.phase != CyclePhase::never)
          F_g = F_g * invert(cycle_.growth(state, view.founder_position(), t));
        axis = invert(view.elastic_deformation() * F_g) * axis;
      }
    after.axis = axis / axis.norm();
  }


  void
  add_cell_cycle(Catalogue &catalogue)
  {
    catalogue.add_own<Proliferation>(
      "cell cycle",
      {"Proliferation/Law=cell cycle",
       "Proliferation/Cell cycle/Start=together",
       "Proliferation/Cell cycle/Duration=0.4",
       "Proliferation/Cell cycle/Division axis=fixed",
       "Proliferation/Cell cycle/Fixed axis=1; 1; 0"});
  }


  template class Proliferation<2>;
  template class Proliferation<3>;
} // namespace Morula
