// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/time_parameters.h>
#include <morula/effects/development.h>

#include <algorithm>
#include <string>

// What befalls a cell in a step: doc/theory.md, sections 6.8 and 6.9.

namespace Morula
{
  namespace
  {
    /** More changes of a cell's type in a step are a mistake. */
    constexpr unsigned int most_changes = 1000;
  } // namespace

  template <int dim>
  typename CellDevelopment<dim>::NextEvent
  CellDevelopment<dim>::next_event(const PresentCell<dim>      &cell,
                                   const CellView<dim, double> &after,
                                   const CycleState<dim>       &next,
                                   const double                 t,
                                   const double                 t1) const
  {
    NextEvent event{t1};
    if (effects.cycle && effects.cycle->divides(next, CellAt<dim>(cell, t), t1))
      event.time =
        std::min(t1, effects.cycle->division_time(next, CellAt<dim>(cell, t)));
    std::optional<Hazard> hazard;
    if (effects.death)
      hazard = effects.death->hazard(cell, after, t, event.time);
    if (hazard)
      if (const auto death = hazard->event(t, event.time))
        {
          event.dies = true;
          event.time = *death;
        }
    if (effects.types)
      event.change = effects.types->next_change(cell, after, t, event.time);
    if (event.change)
      {
        event.dies = false;
        event.time = event.change->time;
      }
    if (hazard)
      effects.death->set_integral(after, hazard->integral_at(t, event.time));
    return event;
  }

  template <int dim>
  CycleState<dim>
  CellDevelopment<dim>::advance(const PresentCell<dim>      &before,
                                const CellView<dim, double> &after,
                                const double                 t0,
                                const double                 t1,
                                std::vector<CellEvent>      &events) const
  {
    const bool      has_clock = effects.cycle.has_value();
    CycleState<dim> state     = has_clock ? clock(after) : CycleState<dim>();
    if (!effects.types && !effects.death)
      return has_clock ? next_clock(before, state, t0, t1) : state;
    double t = t0;
    for (unsigned int n = 0; n < most_changes; ++n)
      {
        // In its state of t0, but for its type.
        const PresentCell<dim> cell(after,
                                    before.id(),
                                    before.position(),
                                    before.reader());
        const CycleState<dim>  next =
          has_clock ? next_clock(cell, state, t, t1) : state;
        const NextEvent event = next_event(cell, after, next, t, t1);
        if (!event.dies && !event.change)
          return next;
        if (has_clock)
          state = next_clock(cell, state, t, event.time);
        if (event.dies)
          return kill(cell, after, state, event.time, DeathCause::rate, events);
        if (has_clock)
          set_clock(after, state);
        events.push_back({event.time,
                          cell.id(),
                          CellEvent::Kind::transition,
                          cell.type(),
                          event.change->to});
        effects.types->change(after, state_, event.change->to, event.time);
        t = event.time;
      }
    throw InputError("Cell types",
                     "",
                     "at most " + std::to_string(most_changes) +
                       " changes of a cell's type in a step",
                     "Lower the rates, or shorten " +
                       TimeParameters::step_path + ".");
  }

  template <int dim>
  CycleState<dim>
  CellDevelopment<dim>::kill(const PresentCell<dim>      &cell,
                             const CellView<dim, double> &after,
                             CycleState<dim>              state,
                             const double                 time,
                             const DeathCause             cause,
                             std::vector<CellEvent>      &events) const
  {
    effects.death->kill(cell, after, time);
    events.push_back({time,
                      cell.id(),
                      CellEvent::Kind::death,
                      cell.type(),
                      cell.type(),
                      cause});
    if (effects.cycle)
      {
        // It keeps the size that it has, and never divides.
        state.growth_pre =
          effects.cycle->growth(state, CellAt<dim>(cell, time), time);
        state.phase = CyclePhase::never;
      }
    return state;
  }

  template <int dim>
  bool
  CellDevelopment<dim>::is_dead_at(const double                 t0,
                                   const PresentCell<dim>      &before,
                                   const CellView<dim, double> &after,
                                   std::vector<CellEvent>      &events) const
  {
    if (!effects.death)
      return false;
    if (effects.death->is_dead(before.cell()))
      return true;
    if (!effects.death->condition_holds(before, t0))
      return false;
    const CycleState<dim> state =
      kill(before,
           after,
           effects.cycle ? clock(after) : CycleState<dim>(),
           t0,
           DeathCause::when,
           events);
    if (effects.cycle)
      set_clock(after, state);
    return true;
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
    if (state_.birth_time.exists())
      daughter.set(state_.birth_time, birth);
    unsigned int own = 0;
    if (effects.types)
      {
        const unsigned int type  = daughter.get(state_.type);
        const auto         types = effects.types->daughters(type);
        own                      = which == 0 ? types.first : types.second;
        if (own != type)
          {
            daughter.set(state_.type, own);
            if (state_.type_since.exists())
              daughter.set(state_.type_since, birth);
          }
      }
    else if (!effects.death)
      return own;
    const CellReader<dim>  reader = this->reader(t1);
    const PresentCell<dim> cell(daughter, id, position, reader);
    const CycleState<dim>  state = advance(cell, daughter, birth, t1, events);
    set_clock(daughter, state);
    return own;
  }

  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
