// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/extrusion.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/tables.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The column of the time of extrusion has this value while a cell is
     *  there. */
    constexpr double stays_in = -1.;
  } // namespace


  ExtrusionParameters::ExtrusionParameters()
    : rate("Extrusion/Rate",
           "0",
           "Rate at which live cells leave the tissue with their volume, which "
           "closes up behind them: an expression of their state, e.g. "
           "5*ramp(pressure, 0.2, 0.5)*(present_depth < 10); not negative. "
           "Units: 1/day.",
           Evaluated::step)
  {
    rate.not_negative("1/day", "0 keeps cells in.");
  }


  bool
  ExtrusionParameters::is_on() const
  {
    return !rate.expression(3).is_always(0.);
  }


  const AnyKey *
  ExtrusionParameters::switch_key() const
  {
    return &rate;
  }


  std::string
  ExtrusionParameters::how_to_switch_on() const
  {
    return "Set " + rate.path();
  }


  std::string
  ExtrusionParameters::details() const
  {
    return "rate = " + rate.text() + " /day";
  }


  KeyList
  ExtrusionParameters::list()
  {
    return {&rate};
  }


  template <int dim>
  Extrusion<dim>::Extrusion(const Parameters         &parameters,
                            const EffectSetting<dim> &setting)
    : rate(setting.state.use(parameters.rate))
    , random_seed(setting.random_seed)
  {
    CellColumns<dim> &columns = setting.columns;
    columns.need_growth();
    integral = columns.template add<double>({"extrusion_hazard",
                                             "",
                                             "rate of extrusion, integrated",
                                             0.,
                                             AtDivision::reset});
    if (rate.follows_state())
      expected = columns.template add<double>(
        {"extrusion_rate",
         "1/day",
         "rate of extrusion that the last step saw; -1: none",
         not_expected,
         AtDivision::reset});
    time = columns.template add<double>({"extrusion_time",
                                         "day",
                                         "when the cell leaves; -1: not yet",
                                         stays_in,
                                         AtDivision::reset});
  }


  template <int dim>
  Hazard
  Extrusion<dim>::hazard(const PresentCell<dim>            &cell,
                         const CellView<dim, const double> &row,
                         const Stretch                     &stretch) const
  {
    // A cell has one threshold for its whole life, as with death.
    return {cell.value(rate, 0.5 * (stretch.begin + stretch.end)),
            row.get(integral),
            Random::threshold_of("extrusion", random_seed, cell.lineage_key())};
  }


  template <int dim>
  std::optional<double>
  Extrusion<dim>::next(const PresentCell<dim>      &cell,
                       const CellView<dim, double> &row,
                       const Stretch               &stretch) const
  {
    // The integral is written as if nothing else happened; pass() sets it again
    // if another fate comes first.
    const Hazard hazard = this->hazard(cell, row, stretch);
    const auto   time   = hazard.event(stretch.begin, stretch.end);
    row.set(integral,
            hazard.integral_at(stretch.begin, time ? *time : stretch.end));
    return time;
  }


  template <int dim>
  void
  Extrusion<dim>::pass(const PresentCell<dim>      &cell,
                       const CellView<dim, double> &row,
                       const Stretch               &stretch,
                       const double                 s) const
  {
    row.set(integral,
            hazard(cell, cell.cell(), stretch).integral_at(stretch.begin, s));
  }


  template <int dim>
  LifeAfter
  Extrusion<dim>::happen(const PresentCell<dim>      &cell,
                         const CellView<dim, double> &row,
                         const Stretch &,
                         const double            s,
                         std::vector<CellEvent> &events) const
  {
    row.set(time, s);
    events.push_back(
      {s, cell.id(), CellEvent::death, cell.type(), cell.type(), "extruded"});
    return LifeAfter::ends;
  }


  template <int dim>
  void
  Extrusion<dim>::make_good(const PresentCell<dim>      &cell,
                            const CellView<dim, double> &row) const
  {
    const PastStep &past = cell.reader().past;
    if (past.exists() && expected.exists())
      row.set(integral,
              with_missed(row.get(integral),
                          cell.value(rate, past.middle()),
                          row.get(expected),
                          past.length()));
  }


  template <int dim>
  void
  Extrusion<dim>::expect(const PresentCell<dim>      &cell,
                         const CellView<dim, double> &row,
                         const double                 t,
                         const bool                   is_whole) const
  {
    if (expected.exists())
      row.set(expected, is_whole ? cell.value(rate, t) : not_expected);
  }


  template <int dim>
  bool
  Extrusion<dim>::is_deadly() const
  {
    return true;
  }


  template <int dim>
  double
  Extrusion<dim>::time_of_death(const CellView<dim, const double> &cell) const
  {
    const double t = cell.get(time);
    return t == stays_in ? std::numeric_limits<double>::infinity() : t;
  }


  template <int dim>
  double
  Extrusion<dim>::removal_time(const CellView<dim, const double> &cell) const
  {
    // The event lies within the step, so the cell goes at its end.
    return time_of_death(cell);
  }


  template <int dim>
  bool
  Extrusion<dim>::shrinks(const CellView<dim, const double> &cell) const
  {
    // Nothing shrinks, but the space is handed on as that of a shrunken cell.
    return cell.get(time) != stays_in;
  }


  template <int dim>
  std::vector<const Expression *>
  Extrusion<dim>::rates(const unsigned int) const
  {
    return {&rate};
  }


  template <int dim>
  void
  Extrusion<dim>::declare(Tables<dim> &tables) const
  {
    // Death has the same counts, which are of both then.
    tables.record_events(true);
    const auto has = [&tables](const std::string &name) {
      return std::any_of(tables.columns().begin(),
                         tables.columns().end(),
                         [&name](const auto &column) {
                           return column.name == name;
                         });
    };
    if (has("deaths"))
      return;
    tables.add_count("deaths", CellEvent::death);
    tables.add_count("removed", CellEvent::removal);
    tables.add_number("pieces");
  }


  template <int dim>
  void
  Extrusion<dim>::check_cell(const PresentCell<dim> &founder,
                             const double) const
  {
    founder.value(rate, 0.);
  }


  template class Extrusion<2>;
  template class Extrusion<3>;
} // namespace Morula
