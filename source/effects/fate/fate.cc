// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/time_parameters.h>
#include <morula/effects/fate/fate.h>
#include <morula/effects/state/neighbour_columns.h>

#include <boost/container/small_vector.hpp>

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

    /** The hazards of a cell in a stretch, and the first event that they bring.
     */
    struct Outlook
    {
      boost::container::small_vector<Hazard, 4> hazards;
      std::optional<double>                     time; // day
      std::size_t                               which = 0;
    };

    /** @param row that of the beginning of the stretch */
    template <int dim>
    Outlook
    outlook(const std::vector<CellHazard<dim>> &hazards,
            const PresentCell<dim>             &cell,
            const CellView<dim, const double>  &row,
            const Stretch                      &stretch)
    {
      // Rates are read from the cell's state of the step's beginning, with the
      // time of the stretch's middle. Each hazard is asked only for an event
      // before the earliest so far. Thresholds follow from the lineage key, so
      // asking again gives the same answer.
      Outlook outlook;
      for (std::size_t k = 0; k < hazards.size(); ++k)
        {
          outlook.hazards.push_back(
            hazards[k].in(stretch.begin, stretch.end, cell, row));
          if (const auto time =
                outlook.hazards[k].event(stretch.begin,
                                         outlook.time.value_or(stretch.end)))
            {
              outlook.time  = time;
              outlook.which = k;
            }
        }
      return outlook;
    }

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
      NextEvent first{NumberOfFate(fates.list.size()), t1, {}};
      for (std::size_t k = 0; k < fates.list.size(); ++k)
        {
          // A fate is asked for events up to the earliest so far. At equal
          // times the later fate has the event, as it is asked up to and with
          // that time.
          first.asked_until[k] = first.time;
          if (const auto time = fates.list[k]->next(cell, row, {t, first.time}))
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
      for (std::size_t k = 0; k < fates.list.size(); ++k)
        // A fate that was asked beyond the event has gone too far and is set
        // back to its time.
        if (k != *event.fate && event.asked_until[k] > event.time)
          fates.list[k]->pass(cell, row, {t, event.asked_until[k]}, event.time);
      const LifeAfter after = fates.list[*event.fate]->happen(
        cell, row, {t, event.asked_until[*event.fate]}, event.time, events);
      if (after == LifeAfter::ends)
        for (const auto &fate : fates.list)
          fate->end_of_life(cell, row, event.time);
      return after;
    }
  } // namespace


  template <int dim>
  std::optional<double>
  Fate<dim>::next(const PresentCell<dim>      &cell,
                  const CellView<dim, double> &row,
                  const Stretch               &stretch) const
  {
    // The integrals are written as if this event happened. If another fate
    // comes first, pass() sets them again.
    const auto   &list    = hazards(cell.type());
    const Outlook outlook = Morula::outlook<dim>(list, cell, row, stretch);
    for (std::size_t k = 0; k < list.size(); ++k)
      row.set(list[k].integral,
              outlook.hazards[k].integral_at(
                stretch.begin, outlook.time.value_or(stretch.end)));
    return outlook.time;
  }


  template <int dim>
  std::size_t
  Fate<dim>::first_hazard(const PresentCell<dim> &cell,
                          const Stretch          &stretch) const
  {
    return outlook(hazards(cell.type()), cell, cell.cell(), stretch).which;
  }


  template <int dim>
  void
  Fate<dim>::check_cell(const PresentCell<dim> &founder, const double) const
  {
    for (const CellHazard<dim> &hazard : hazards(founder.type()))
      founder.value(hazard.rate, 0.);
  }


  template <int dim>
  void
  Fates<dim>::add(std::unique_ptr<const Fate<dim>> fate)
  {
    // A scene has at most one fate that divides cells: a cell cycle refuses
    // others.
    if (const auto *const divides =
          dynamic_cast<const Divides<dim> *>(fate.get());
        divides != nullptr && dividing == nullptr)
      dividing = divides;
    if (const auto *const dies = dynamic_cast<const Dies<dim> *>(fate.get()))
      deadly.push_back(dies);
    list.push_back(std::move(fate));
  }


  template <int dim>
  void
  Fates<dim>::live(const PresentCell<dim>      &before,
                   const CellView<dim, double> &row,
                   const double                 t0,
                   const double                 t1,
                   std::vector<CellEvent>      &events,
                   const TypesAround<dim>      *around) const
  {
    // Each round takes the cell from one event to the next, of its own or
    // beside it. All fates see the cell as it was when the step began, but for
    // its type, those beside it, and what they keep of it: the row of the
    // round's beginning is copied, as fates write into `row` while they look
    // for their events. The round without an event, or a death or a division,
    // is the last.
    if (list.empty())
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
        const NextEvent        event = next_event(*this, cell, row, t, until);
        if (event.fate)
          {
            ++n;
            if (happen(*this, event, cell, row, t, events) !=
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
  Fates<dim>::is_dead_at(const PresentCell<dim>      &before,
                         const CellView<dim, double> &row,
                         const double                 t,
                         std::vector<CellEvent>      &events) const
  {
    // A condition strikes at the beginning of the step, before all other
    // events. The first fate that strikes has the cell; all fates then learn
    // that its life has ended.
    if (is_dead(before.cell()))
      return true;
    for (const Dies<dim> *const dies : deadly)
      if (dies->strikes(before, t))
        {
          dies->strike(before, row, t, events);
          for (const auto &fate : list)
            fate->end_of_life(before, row, t);
          return true;
        }
    return false;
  }


  template class Fate<2>;
  template class Fate<3>;
  template struct Fates<2>;
  template struct Fates<3>;


  std::optional<double>
  Hazard::event(const double t0, const double t1) const
  {
    // The rate is constant in the stretch, so the integral reaches the
    // threshold at the time of doc/theory.md (6.7). A threshold that was passed
    // by what the last step missed is passed at once. The negated comparison
    // leaves out rates that are NaN.
    const double left = threshold - integral;
    if (left <= 0.)
      return t0;
    if (!(rate > 0. && left <= rate * (t1 - t0)))
      return {};
    return t0 + left / rate;
  }


  double
  with_missed(const double integral,
              const double rate,
              const double expected,
              const double dt)
  {
    // This is doc/theory.md (5.9). An expected rate below zero means that there
    // is nothing to compare. The integral of a rate is never negative.
    return expected >= 0. ?
             std::max(0., integral + 0.5 * dt * (rate - expected)) :
             integral;
  }


  template <int dim>
  void
  CellHazard<dim>::make_good(const PresentCell<dim>      &before,
                             const CellView<dim, double> &row) const
  {
    // Where the last step expected nothing the rate may have no value.
    const PastStep &past = before.reader().past;
    if (past.exists() && expected.exists() && row.get(expected) >= 0.)
      row.set(integral,
              with_missed(row.get(integral),
                          before.value(rate, past.middle()),
                          row.get(expected),
                          past.length()));
  }


  template <int dim>
  void
  CellHazard<dim>::expect(const PresentCell<dim>      &before,
                          const CellView<dim, double> &row,
                          const double                 t,
                          const bool                   is_whole) const
  {
    // An integral that began or ended in the step is one of another time.
    if (expected.exists())
      row.set(expected,
              is_whole && (!runs || (runs(before.cell()) && runs(row))) ?
                before.value(rate, t) :
                not_expected);
  }


  template struct CellHazard<2>;
  template struct CellHazard<3>;
} // namespace Morula
