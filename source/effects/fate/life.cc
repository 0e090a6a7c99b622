// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/time_parameters.h>
#include <morula/effects/fate/life.h>

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace Morula
{
  namespace
  {
    /** A cell with more events in a step has a rate that is a mistake: without
     * a limit the loop would not end. */
    constexpr unsigned int most_events = 1000;

    /** A copy of a cell's row, and a number for each fate. Up to these sizes
     * they lie on the stack: live() is called for each cell in each step. */
    using Row          = boost::container::small_vector<double, 128>;
    using NumberOfFate = boost::container::small_vector<double, 8>;

    /** The first event of a cell, and what the fates were asked. */
    struct NextEvent
    {
      NumberOfFate               asked_until; // day
      double                     time;        // day; the end if there is none
      std::optional<std::size_t> fate;
    };

    /** Asks each fate for an event before those of the fates before it. */
    template <int dim>
    NextEvent
    next_event(const Fates<dim>            &fates,
               const PresentCell<dim>      &cell,
               const CellView<dim, double> &row,
               const double                 t,
               const double                 t1)
    {
      NextEvent first{NumberOfFate(fates.size()), t1, {}};
      for (std::size_t k = 0; k < fates.size(); ++k)
        {
          // A fate is asked for events up to the earliest so far. At equal
          // times the later fate has the event, as it is asked up to and with
          // that time.
          first.asked_until[k] = first.time;
          if (const auto time = fates[k]->next(cell, row, {t, first.time}))
            {
              first.time = *time;
              first.fate = k;
            }
        }
      return first;
    }

    /** Lets the event happen, and takes the other fates to its time.
     *  @return what it leaves of the cell's life */
    template <int dim>
    LifeAfter
    happen(const Fates<dim>            &fates,
           const NextEvent             &event,
           const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const double                 t,
           std::vector<CellEvent>      &events)
    {
      for (std::size_t k = 0; k < fates.size(); ++k)
        // A fate that was asked beyond the event has gone too far and is set
        // back to its time.
        if (k != *event.fate && event.asked_until[k] > event.time)
          fates[k]->pass(cell, row, {t, event.asked_until[k]}, event.time);
      const LifeAfter after = fates[*event.fate]->happen(
        cell, row, {t, event.asked_until[*event.fate]}, event.time, events);
      if (after == LifeAfter::ends)
        for (const auto &fate : fates)
          fate->end_of_life(cell, row, event.time);
      return after;
    }
  } // namespace


  template <int dim>
  void
  live(const Fates<dim>            &fates,
       const PresentCell<dim>      &before,
       const CellView<dim, double> &row,
       const double                 t0,
       const double                 t1,
       std::vector<CellEvent>      &events,
       const TypesAround<dim>      *around)
  {
    // Each round takes the cell from one event to the next, of its own or
    // beside it. All fates see the cell as it was when the step began, but for
    // its type, those beside it, and what they keep of it: the row of the
    // round's beginning is copied, as fates write into `row` while they look
    // for their events. The round without an event, or a death or a division,
    // is the last.
    if (fates.empty())
      return;
    double            t = t0;
    Row               at_t;
    const std::size_t n_changes = around != nullptr ? around->size() : 0;
    std::size_t       n_seen    = around != nullptr ? around->n_before(t0) : 0;
    for (unsigned int n = 0; n < most_events;)
      {
        if (around != nullptr)
          around->set(row, n_seen);
        const bool   is_last = n_seen == n_changes;
        const double until   = is_last ? t1 : around->time(n_seen);
        at_t.assign(row.row().begin(), row.row().end());
        const CellView<dim, const double> view(
          ArrayView<const double>(at_t.data(), at_t.size()), row.columns());
        const PresentCell<dim> cell(view,
                                    before.id(),
                                    before.position(),
                                    before.reader());
        const NextEvent        event = next_event(fates, cell, row, t, until);
        if (event.fate)
          {
            ++n;
            if (happen(fates, event, cell, row, t, events) !=
                LifeAfter::goes_on)
              return;
          }
        else if (is_last)
          return;
        else
          ++n_seen;
        t = event.time;
      }
    throw InputError("Cell types",
                     "",
                     "at most " + std::to_string(most_events) +
                       " changes of a cell's type in a step",
                     "Lower the rates, or shorten " +
                       TimeParameters::step_path + ".");
  }


  template <int dim>
  bool
  is_dead_at(const Fates<dim>            &fates,
             const PresentCell<dim>      &before,
             const CellView<dim, double> &row,
             const double                 t,
             std::vector<CellEvent>      &events)
  {
    // A condition strikes at the beginning of the step, before all other
    // events. The first fate that strikes has the cell; all fates then learn
    // that its life has ended.
    if (is_dead(fates, before.cell()))
      return true;
    for (const auto &fate : fates)
      if (fate->strikes(before, t))
        {
          fate->strike(before, row, t, events);
          for (const auto &other : fates)
            other->end_of_life(before, row, t);
          return true;
        }
    return false;
  }


  template <int dim>
  double
  time_of_death(const Fates<dim>                  &fates,
                const CellView<dim, const double> &cell)
  {
    double time = std::numeric_limits<double>::infinity();
    for (const auto &fate : fates)
      time = std::min(time, fate->time_of_death(cell));
    return time;
  }


  template <int dim>
  bool
  is_dead(const Fates<dim> &fates, const CellView<dim, const double> &cell)
  {
    return std::isfinite(time_of_death(fates, cell));
  }


  MORULA_INSTANTIATE(live);
  MORULA_INSTANTIATE(is_dead_at);
  MORULA_INSTANTIATE(time_of_death);
  MORULA_INSTANTIATE(is_dead);
} // namespace Morula
