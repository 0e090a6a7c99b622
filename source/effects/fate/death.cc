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
    /** The death time of cells that live. */
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
    // What goes at once does not collapse first.
    if (whole == 0. && row.get(stays) == 0)
      return 1.;
    // doc/theory.md (6.9)
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
    return is_dead(cell) && cell.get(stays) == 0 ?
             cell.get(time_) + cell.get(duration) :
             std::numeric_limits<double>::infinity();
  }


  template <int dim>
  bool
  Death<dim>::may_strike() const
  {
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
