// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/effect.h>
#include <morula/effects/fate/end_at_rate.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/tables.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The column of the time has this value while a cell lives. No life ends
     *  before t = 0, so -1 is free. */
    constexpr double never = -1.;
  } // namespace


  template <int dim>
  CellHazard<dim>
  EndAtRate<dim>::hazard_of(const ExpressionKey      &rate,
                            const EffectSetting<dim> &setting,
                            const std::string        &name)
  {
    // The rate is announced first, as it decides which columns the state has.
    // Without a rate there is no integral, and a rate that does not follow the
    // state misses nothing.
    const Expression  of_cell = setting.state.use(rate);
    const std::string what    = "rate of " + name;
    Column<double>    integral, expected;
    setting.columns.need_growth();
    if (!of_cell.is_always(0.))
      integral = setting.columns.template add<double>(
        {name + "_hazard", "", what + ", integrated", 0., AtDivision::reset});
    if (integral.exists() && of_cell.follows_state())
      expected = setting.columns.template add<double>(
        {name + "_rate",
         "1/day",
         what + " that the last step saw; -1: none",
         not_expected,
         AtDivision::reset});
    return {of_cell, integral, expected};
  }


  template <int dim>
  EndAtRate<dim>::EndAtRate(const ExpressionKey      &rate,
                            const EffectSetting<dim> &setting,
                            const Words              &words)
    : hazard(hazard_of(rate, setting, words.name))
    , time(setting.columns.template add<double>({words.name + "_time",
                                                 "day",
                                                 words.meaning,
                                                 never,
                                                 AtDivision::reset,
                                                 words.in_tables}))
    , random_seed(setting.random_seed)
    , nobody(words.nobody)
  {}


  template <int dim>
  std::optional<double>
  EndAtRate<dim>::next(const PresentCell<dim>      &cell,
                       const CellView<dim, double> &row,
                       const Stretch               &stretch) const
  {
    // The integral is written as if nothing else happened; pass() sets it again
    // if another fate comes first.
    if (!hazard.exists())
      return {};
    const Hazard of_cell =
      hazard.in(stretch, cell, row, threshold(random_seed, cell.lineage_key()));
    const auto event = of_cell.event(stretch.begin, stretch.end);
    hazard.integrate(of_cell, stretch, event.value_or(stretch.end), row);
    return event;
  }


  template <int dim>
  void
  EndAtRate<dim>::pass(const PresentCell<dim>      &cell,
                       const CellView<dim, double> &row,
                       const Stretch               &stretch,
                       const double                 s) const
  {
    // The integral of the round's beginning is in `cell`, since next() has
    // changed `row`. The threshold is not asked for.
    if (hazard.exists())
      hazard.integrate(hazard.in(stretch, cell, cell.cell(), 0.),
                       stretch,
                       s,
                       row);
  }


  template <int dim>
  void
  EndAtRate<dim>::make_good(const PresentCell<dim>      &before,
                            const CellView<dim, double> &row) const
  {
    hazard.make_good(before, row);
  }


  template <int dim>
  void
  EndAtRate<dim>::expect(const PresentCell<dim>      &before,
                         const CellView<dim, double> &row,
                         const double                 t,
                         const bool                   is_whole) const
  {
    hazard.expect(before, row, t, is_whole);
  }


  template <int dim>
  std::vector<const Expression *>
  EndAtRate<dim>::rates(const unsigned int) const
  {
    return {&hazard.rate()};
  }


  template <int dim>
  void
  EndAtRate<dim>::declare(Tables<dim> &tables) const
  {
    // The numbers of pieces are known to the run only; here the column is
    // announced. The first of such fates announces it all.
    tables.record_events(true);
    const auto &columns = tables.columns();
    if (std::any_of(columns.begin(), columns.end(), [](const auto &column) {
          return column.name == "deaths";
        }))
      return;
    tables.add_count("deaths", CellEvent::death);
    tables.add_count("removed", CellEvent::removal);
    tables.add_number("pieces");
  }


  template <int dim>
  void
  EndAtRate<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    review_rate(hazard.rate(), nobody, scene, review);
  }


  template <int dim>
  void
  EndAtRate<dim>::end(const CellView<dim, double> &row, const double t) const
  {
    row.set(time, t);
  }


  template <int dim>
  bool
  EndAtRate<dim>::has_ended(const CellView<dim, const double> &cell) const
  {
    return cell.get(time) != never;
  }


  template class EndAtRate<2>;
  template class EndAtRate<3>;
} // namespace Morula
