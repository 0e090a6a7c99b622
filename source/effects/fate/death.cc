// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/death.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/tables.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The column of the time of death has this value while a cell lives. No
     * cell dies before t = 0, so -1 is free. */
    constexpr double never = -1.;
  } // namespace


  template <int dim>
  Death<dim>::Death(const Parameters         &parameters,
                    const EffectSetting<dim> &setting)
    : rate_(setting.state.use(parameters.rate))
    , when(setting.state.use(parameters.when))
    , shrinking_time(setting.state.use(parameters.shrinking_time))
    , final_volume(setting.state.use(parameters.final_volume))
    , keep_debris(setting.state.use(parameters.keep_debris))
    , has_rate(!rate_.is_always(0.))
    , has_condition(!when.is_always(0.))
    , random_seed(setting.random_seed)
    , slack(setting.slack)
  {
    // Expressions are announced first, as they decide which columns the state
    // has. Without a rate there is no integral, and a rate that does not follow
    // the state misses nothing, so these two columns are optional. What is
    // fixed at the moment of death is stored with the cell, as the expressions
    // go on changing.
    CellColumns<dim> &columns = setting.columns;
    columns.need_growth();
    if (has_rate)
      integral = columns.template add<double>({"death_hazard",
                                               "",
                                               "rate of death, integrated",
                                               0.,
                                               AtDivision::reset});
    if (has_rate && rate_.follows_state())
      expected = columns.template add<double>(
        {"death_rate",
         "1/day",
         "rate of death that the last step saw; -1: none",
         not_expected,
         AtDivision::reset});
    time_ = columns.template add<double>({"death_time",
                                          "day",
                                          "when the cell died; -1: it lives",
                                          never,
                                          AtDivision::reset,
                                          true});
    remaining =
      columns.template add<double>({"remaining_volume",
                                    "",
                                    "part of its grown volume at death that "
                                    "the cell has left; 1: it lives",
                                    1.,
                                    AtDivision::reset,
                                    true});
    duration = columns.template add<double>(
      {"shrinking_time", "day", "how long the dead cell shrinks"});
    least = columns.template add<double>(
      {"final_volume", "", "remaining volume at the end"});
    stays = columns.template add<unsigned int>(
      {"is_debris", "", "whether the dead cell stays"});
  }


  template <int dim>
  bool
  Death<dim>::is_dead(const CellView<dim, const double> &cell) const
  {
    return cell.get(time_) != never;
  }


  template <int dim>
  double
  Death<dim>::time_of_death(const CellView<dim, const double> &cell) const
  {
    return is_dead(cell) ? cell.get(time_) :
                           std::numeric_limits<double>::infinity();
  }


  template <int dim>
  bool
  Death<dim>::is_deadly() const
  {
    return true;
  }


  template <int dim>
  bool
  Death<dim>::strikes(const PresentCell<dim> &cell, const double t) const
  {
    // The last member marks the event as a death by a condition, not by a rate.
    return has_condition && cell.value(when, t) > 0.;
  }


  template <int dim>
  void
  Death<dim>::strike(const PresentCell<dim>      &cell,
                     const CellView<dim, double> &row,
                     const double                 t,
                     std::vector<CellEvent>      &events) const
  {
    kill(cell, row, t);
    events.push_back(
      {t, cell.id(), CellEvent::death, cell.type(), cell.type(), "when", true});
  }


  template <int dim>
  Hazard
  Death<dim>::hazard(const PresentCell<dim>            &cell,
                     const CellView<dim, const double> &row,
                     const Stretch                     &stretch) const
  {
    // A cell has one threshold for its whole life: a change of its type changes
    // the rate and keeps the integral, doc/theory.md section 6.9.
    return {cell.value(rate_, 0.5 * (stretch.begin + stretch.end)),
            row.get(integral),
            Random::death_threshold(random_seed, cell.lineage_key())};
  }


  template <int dim>
  std::optional<double>
  Death<dim>::next(const PresentCell<dim>      &cell,
                   const CellView<dim, double> &row,
                   const Stretch               &stretch) const
  {
    // The integral is written as if nothing else happened; pass() sets it again
    // if another fate comes first.
    if (!has_rate)
      return {};
    const Hazard hazard = this->hazard(cell, row, stretch);
    const auto   time   = hazard.event(stretch.begin, stretch.end);
    row.set(integral,
            hazard.integral_at(stretch.begin, time ? *time : stretch.end));
    return time;
  }


  template <int dim>
  void
  Death<dim>::pass(const PresentCell<dim>      &cell,
                   const CellView<dim, double> &row,
                   const Stretch               &stretch,
                   const double                 s) const
  {
    // The integral of the round's beginning is in `cell`, since next() has
    // changed `row`.
    if (has_rate)
      row.set(integral,
              hazard(cell, cell.cell(), stretch).integral_at(stretch.begin, s));
  }


  template <int dim>
  LifeAfter
  Death<dim>::happen(const PresentCell<dim>      &cell,
                     const CellView<dim, double> &row,
                     const Stretch &,
                     const double            s,
                     std::vector<CellEvent> &events) const
  {
    kill(cell, row, s);
    events.push_back(
      {s, cell.id(), CellEvent::death, cell.type(), cell.type(), "rate"});
    return LifeAfter::ends;
  }


  template <int dim>
  void
  Death<dim>::make_good(const PresentCell<dim>      &cell,
                        const CellView<dim, double> &row) const
  {
    const PastStep &past = cell.reader().past;
    if (past.exists() && expected.exists())
      row.set(integral,
              with_missed(row.get(integral),
                          cell.value(rate_, past.middle()),
                          row.get(expected),
                          past.length()));
  }


  template <int dim>
  void
  Death<dim>::expect(const PresentCell<dim>      &cell,
                     const CellView<dim, double> &row,
                     const double                 t,
                     const bool                   is_whole) const
  {
    if (expected.exists())
      row.set(expected, is_whole ? cell.value(rate_, t) : not_expected);
  }


  template <int dim>
  void
  Death<dim>::kill(const PresentCell<dim>      &cell,
                   const CellView<dim, double> &row,
                   const double                 t) const
  {
    // The times and volumes of the shrinking are those of the moment of death,
    // and so is the decision whether the cell stays.
    row.set(time_, t);
    row.set(duration, cell.value(shrinking_time, t));
    row.set(least, cell.value(final_volume, t));
    row.set(stays, cell.value(keep_debris, t) > 0.);
  }


  template <int dim>
  double
  Death<dim>::shrink(const CellView<dim, double> &row, const double t) const
  {
    const double whole = row.get(duration);
    // A cell that is removed at the end of this step is whole until then: a
    // collapse before would pull at its neighbours.
    if (whole == 0. && row.get(stays) == 0)
      return 1.;
    // This is s of doc/theory.md (6.9), as a ratio to what the last step left:
    // F_g has the former shrinking in it already.
    const double part =
      whole > 0. ? std::clamp((t - row.get(time_)) / whole, 0., 1.) : 1.;
    const double before = row.get(remaining);
    const double after  = 1. - (1. - row.get(least)) * part;
    row.set(remaining, after);
    return std::pow(after / before, 1. / dim);
  }


  template <int dim>
  double
  Death<dim>::removal_time(const CellView<dim, const double> &cell) const
  {
    // Cells that live, and debris, are never removed.
    return is_dead(cell) && cell.get(stays) == 0 ?
             cell.get(time_) + cell.get(duration) :
             std::numeric_limits<double>::infinity();
  }


  template <int dim>
  bool
  Death<dim>::may_strike() const
  {
    // This says whether a condition may take cells at once. A shrinking time
    // that is a positive constant rules it out; an expression may be zero
    // somewhere.
    return has_condition && !(shrinking_time.is_constant() &&
                              shrinking_time.number().value_or(0.) > 0.);
  }


  template <int dim>
  std::vector<const Expression *>
  Death<dim>::rates(const unsigned int) const
  {
    return {&rate_};
  }


  template <int dim>
  bool
  Death<dim>::shrinks(const CellView<dim, const double> &cell) const
  {
    return is_dead(cell) && cell.get(duration) > 0.;
  }


  template <int dim>
  bool
  Death<dim>::is_due_for_removal(const CellView<dim, const double> &cell,
                                 const double                       t) const
  {
    return removal_time(cell) <= t + slack;
  }


  template <int dim>
  void
  Death<dim>::declare(Tables<dim> &tables) const
  {
    // The numbers of pieces are known to the run only; here the column is
    // announced.
    tables.record_events(true);
    tables.add_sum("dying", [this](const PresentCell<dim> &cell) {
      return is_dead(cell.cell()) ? 1. : 0.;
    });
    tables.add_count("deaths", CellEvent::death);
    tables.add_count("removed", CellEvent::removal);
    tables.add_number("pieces");
  }


  template <int dim>
  void
  Death<dim>::check_cell(const PresentCell<dim> &founder, const double) const
  {
    for (const Expression *expression :
         {&rate_, &when, &shrinking_time, &final_volume, &keep_debris})
      founder.value(*expression, 0.);
  }


  template class Death<2>;
  template class Death<3>;
} // namespace Morula
