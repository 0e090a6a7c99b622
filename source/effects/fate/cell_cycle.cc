// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/present_cell.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** (I + amount n⊗n) F, the growth along n of doc/theory.md (6.2). */
    template <int dim>
    Tensor<2, dim>
    stretched_along(const Tensor<1, dim> &n,
                    const double          amount,
                    const Tensor<2, dim> &F)
    {
      return F + amount * outer_product(n, n * F);
    }
  } // namespace


  void
  CellCycleParameters::see(const SceneKeys &scene,
                           const std::vector<ExpressionKey *> &)
  {
    // Cells of a type that does not proliferate stay in G0: their rate of
    // leaving it is set to 0, so that one cell cycle serves all types.
    const auto &types = scene.cell_types.types;
    is_law_of_types =
      std::any_of(types.begin(), types.end(), [](const CellTypeKeys &type) {
        return !type.proliferation_law->empty() &&
               type.proliferation_law != "none";
      });
    if (!is_on())
      return;
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        const Key<std::string> &own     = types[i].proliferation_law;
        const Key<std::string> &of_type = own->empty() ? law : own;
        if (of_type == "none")
          exit_rate.set_for_type(i, of_type.path(), "0");
      }
  }


  template <int dim>
  CellAt<dim>::CellAt(const PresentCell<dim> &cell, const double t)
    : X(cell.cell().founder_position())
    , cell(&cell)
    , t(t)
  {}


  template <int dim>
  double
  CellAt<dim>::value(const Expression &expression, const double when) const
  {
    // An expression of X alone keeps the founder's value, also where there is
    // no cell with a state, as before the run.
    return depends_on_more_than_place(expression) ?
             cell->value(expression, when) :
             expression.value(X, 0.);
  }


  template <int dim>
  CellCycle<dim>::CellCycle(const CellCycleParameters &parameters,
                            const std::uint64_t        seed,
                            const double               slack)
    : CellCycle(parameters, seed, slack, *std::make_unique<StateColumns<dim>>())
  {}


  template <int dim>
  CellCycle<dim>::CellCycle(const CellCycleParameters &parameters,
                            const std::uint64_t        seed,
                            const double               slack,
                            StateColumns<dim>         &state)
    : duration(state.use(parameters.duration, false))
    , exit_rate(state.use(parameters.exit_rate, false))
    , size_checkpoint(state.use(parameters.size_checkpoint, false))
    , where(parameters.where.expression(dim))
    , start_together(parameters.start == "together")
    , seed(seed)
    , slack(slack)
    // The flags are kept, as they are asked for each cell in each step: whether
    // an expression needs the state decides which columns the cycle has.
    , own_duration(depends_on_more_than_place(duration))
    , own_hazard(depends_on_more_than_place(exit_rate))
  {}


  template <int dim>
  CycleState<dim>
  CellCycle<dim>::founder(const types::particle_index id,
                          const CellAt<dim>          &at) const
  {
    // The phase stays `never` outside of Where. All random numbers of a cell
    // follow from its key, which is drawn from the seed and its id: they do not
    // depend on ranks or on the order in which founders are made.
    CycleState<dim> state;
    state.growth_pre = unit_symmetric_tensor<dim>();
    state.key        = Random::founder_key(seed, id);

    if (!(at.value(where) > 0.))
      return state;

    state.phase = CyclePhase::waiting;
    // Types that do not proliferate have the rate 0: they wait for ever instead
    // of starting together with the others.
    if (start_together && !(has_own_hazard() && at.value(exit_rate) == 0.))
      // This is a wait that ends at once. A cell that starts has J_e = 1; where
      // the checkpoint is above that, the cell is held.
      return advance(state, at, 0., 0., {1.});

    wait(state, at, 0.);
    return state;
  }


  template <int dim>
  CycleState<dim>
  CellCycle<dim>::founder_in_phase(const types::particle_index id,
                                   const CellAt<dim>          &at,
                                   const unsigned int          phase) const
  {
    // A file says the phase of this founder. Phase 9 never proliferates and
    // phase 0 waits; else the cell is on its way, and where in its phase it
    // stands is drawn, doc/theory.md (6.2a). The onset of S then lies before t
    // = 0.
    CycleState<dim> state;
    state.growth_pre = unit_symmetric_tensor<dim>();
    state.key        = Random::founder_key(seed, id);
    if (phase == 9 || !(at.value(where) > 0.))
      return state;
    if (phase == 0)
      {
        state.phase = CyclePhase::waiting;
        wait(state, at, 0.);
        return state;
      }
    Assert(phase == 1 || phase == 2 || phase == 4, ExcInternalError());
    const double T = at.value(duration);
    if (has_own_duration())
      state.duration = T;
    // S and G2 take a quarter of the cycle each, and G1 the second half. M is
    // the moment of division, in the middle.
    const double before = phase == 1 ? 0. : phase == 2 ? 0.25 : 0.5;
    const double length = phase == 4 ? 0.5 : 0.25;
    state.phase = phase == 4 ? CyclePhase::divided : CyclePhase::growing;
    state.event_time =
      -(before + length * Random::part_of_phase(seed, state.key)) * T;
    // A founder in G1 is a daughter whose axis was her mother's. Its own key is
    // for its next cycle, so the axis gets another one.
    const std::uint64_t key =
      phase == 4 ? Random::past_key(seed, state.key) : state.key;
    state.axis = Random::direction<dim>(seed, key);
    return state;
  }


  template <int dim>
  CycleState<dim>
  CellCycle<dim>::advance(CycleState<dim>    state,
                          const CellAt<dim> &at,
                          const double       t0,
                          const double       t1,
                          const ElasticSize &size) const
  {
    // Two passes take the clock through [t0, t1]. The first ends a cycle that
    // is due, or goes on with the wait. The second starts S if the wait has
    // ended and the checkpoint lets the cell pass; it may do so in the same
    // step. Division is not done here: it needs the other cells, and a growing
    // cell only says that it is due.
    if (state.phase == CyclePhase::divided)
      {
        // G1 is (T/2, T]: a cycle that ends at t1 is left in the next step.
        const double cycle_end = state.event_time + cycle_duration(state, at);
        if (cycle_end < t1 - slack)
          {
            // The stretch of the whole cycle becomes part of the growth before
            // the next one, doc/theory.md (6.3), and G0 begins at the exact
            // end.
            state.growth_pre =
              stretched_along(state.axis, 1., state.growth_pre);
            state.axis  = Tensor<1, dim>();
            state.phase = CyclePhase::waiting;
            wait(state, at, cycle_end);
            integrate_hazard(state, at, cycle_end, t1);
          }
      }
    else if (state.phase == CyclePhase::waiting)
      integrate_hazard(state, at, t0, t1);

    if (state.phase != CyclePhase::waiting)
      return state;
    const double begin = onset(state, at, t0, t1, size);
    if (std::isfinite(begin))
      {
        state.phase      = CyclePhase::growing;
        state.event_time = begin;
        if (has_own_duration())
          {
            // The duration is that of the moment of the onset: a cell that is
            // on its way keeps its clock, whatever becomes of its state.
            state.duration = at.value(duration, begin);
            check_step(state.duration, t1 - t0);
          }
        state.axis = Random::direction<dim>(seed, state.key);
      }

    return state;
  }


  template <int dim>
  Tensor<2, dim>
  CellCycle<dim>::growth(const CycleState<dim> &state,
                         const CellAt<dim>     &at,
                         const double           t) const
  {
    // This is doc/theory.md (6.2) with θ - 1 = (t - t_S)/T. It is the same
    // before and after the division, so that division changes no stress.
    if (state.phase != CyclePhase::growing &&
        state.phase != CyclePhase::divided)
      return state.growth_pre;

    // The quotient is within [0, 1] but for the slack of times, which the clamp
    // cuts off.
    const double theta_minus_1 =
      std::clamp((t - state.event_time) / cycle_duration(state, at), 0., 1.);
    return stretched_along(state.axis, theta_minus_1, state.growth_pre);
  }


  template <int dim>
  std::pair<CycleState<dim>, CycleState<dim>>
  CellCycle<dim>::daughters(const CycleState<dim> &mother) const
  {
    // Both daughters go on with the mother's clock, axis and growth. Only their
    // keys are new, so that their later draws differ.
    Assert(mother.phase == CyclePhase::growing, ExcInternalError());

    std::pair<CycleState<dim>, CycleState<dim>> states(mother, mother);
    states.first.phase  = CyclePhase::divided;
    states.second.phase = CyclePhase::divided;
    states.first.key    = Random::daughter_key(seed, mother.key, 0);
    states.second.key   = Random::daughter_key(seed, mother.key, 1);
    return states;
  }


  template <int dim>
  unsigned int
  CellCycle<dim>::phase_number(const CycleState<dim> &state,
                               const CellAt<dim>     &at,
                               const double           t) const
  {
    // These are the numbers of the outputs: 0 is G0, 1 S, 2 G2, 3 M, 4 G1, and
    // 9 never proliferates. M has no length, so it is the state at the moment
    // of the division.
    if (state.phase == CyclePhase::never)
      return 9;
    if (state.phase == CyclePhase::waiting)
      return 0;

    const double T   = cycle_duration(state, at);
    const double age = t - state.event_time;
    if (std::abs(age - 0.5 * T) <= slack)
      return 3;
    if (state.phase == CyclePhase::divided)
      return 4;
    return age < 0.25 * T - slack ? 1 : 2;
  }


  template <int dim>
  double
  CellCycle<dim>::onset(const CycleState<dim> &state,
                        const CellAt<dim>     &at,
                        const double           t0,
                        const double           t1,
                        const ElasticSize     &size) const
  {
    // The wait ends at t_e, which may lie in this step or, for a cell that was
    // held, before it. J_e is known at the beginnings of steps only and is
    // thought to go on as in the step before. Without a checkpoint the wait
    // alone decides; then S may begin at a time before t0 only by rounding,
    // which the maximum removes.
    const double never = std::numeric_limits<double>::infinity();
    const double t_e   = state.event_time;
    if (t_e > t1 + slack)
      return never;
    if (!has_checkpoint())
      return std::max(t_e, t0);
    if (t_e > t0)
      { // The wait ends within this step: J_e goes on with the last one's
        // slope.
        const double J_e = size.J_e + size.slope * (t_e - t0);
        return passes_checkpoint(at, J_e, t_e) ? t_e : never;
      }
    if (!passes_checkpoint(at, size.J_e, t0))
      return never;
    // The cell was held and passes now: J_e rose past the threshold since the
    // last step began, doc/theory.md (6.3g).
    const double since = std::max(t_e, std::min(size.since, t0));
    const double above = size.J_e - at.value(size_checkpoint, t0);
    if (!(size.slope > 0. && size.since < t0))
      return since;
    // The time is rounded to parts of the step that are far longer than the
    // rounding of J_e. So cells that are equal have equal times on any ranks,
    // and their daughters are numbered in the same order.
    constexpr double n_parts = 1u << 20;
    const double     part    = (t0 - size.since) / n_parts;
    const double     n       = std::round(above / size.slope / part);
    return std::max(since, t0 - n * part);
  }


  template <int dim>
  void
  CellCycle<dim>::wait(CycleState<dim>   &state,
                       const CellAt<dim> &at,
                       const double       t) const
  {
    // A wait with a constant rate ends at a time that is drawn at once.
    // Otherwise the end is unknown, and integrate_hazard() finds it step by
    // step with the same draw.
    state.hazard = 0.;
    state.event_time =
      has_own_hazard() ?
        std::numeric_limits<double>::infinity() :
        t + Random::exponential(seed, state.key, at.value(exit_rate));
  }


  template <int dim>
  void
  CellCycle<dim>::integrate_hazard(CycleState<dim>   &state,
                                   const CellAt<dim> &at,
                                   const double       t0,
                                   const double       t1) const
  {
    // The rate is taken at the middle of the stretch, which makes what depends
    // on time alone exact to second order. An end that is known already stays.
    if (!has_own_hazard() || std::isfinite(state.event_time))
      return;
    // This is doc/theory.md (6.8).
    const Hazard hazard{at.value(exit_rate, 0.5 * (t0 + t1)),
                        state.hazard,
                        Random::exponential(seed, state.key, 1.)};
    state.event_time = hazard.event(t0, t1).value_or(state.event_time);
    state.hazard     = hazard.integral_at(t0, t1);
  }


  template <int dim>
  double
  CellCycle<dim>::checked_duration(const CellAt<dim> &at,
                                   const bool         in_its_state) const
  {
    // The rules of the keys refuse bad values. check() has no cell and
    // evaluates the expressions of X alone; check_cell() has one and evaluates
    // the rest. A duration that is not known here must not shorten the step.
    const auto is_known = [&](const Expression &expression) {
      return depends_on_more_than_place(expression) == in_its_state;
    };
    const double T = is_known(duration) ?
                       at.value(duration) :
                       std::numeric_limits<double>::infinity();
    for (const Expression *const other : {&exit_rate, &size_checkpoint})
      if (is_known(*other))
        at.value(*other);
    return T;
  }


  template <int dim>
  void
  CellCycle<dim>::check_step(const double shortest, const double step) const
  {
    // A cell divides T/2 after the onset and could divide twice in a longer
    // step; only one division per step is provided for. The slack admits a step
    // of T/2 with rounding.
    if (step <= 0.5 * shortest + slack)
      return;
    std::ostringstream value, limit;
    value << step;
    limit << "at most half the shortest cell cycle, " << 0.5 * shortest
          << " day";
    throw InputError(TimeParameters::step_path,
                     value.str(),
                     limit.str(),
                     "Shorten the step, or lengthen " + duration.key() + ".");
  }


  template class CellAt<2>;
  template class CellAt<3>;
  template class CellCycle<2>;
  template class CellCycle<3>;
} // namespace Morula
