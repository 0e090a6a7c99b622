// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/effect.h>
#include <morula/effects/fate/death.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/tables.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  template <int dim>
  Death<dim>::Death(const Parameters         &parameters,
                    const EffectSetting<dim> &setting)
    : EndAtRate<dim>(parameters.rate,
                     setting,
                     {"death",
                      "when the cell died; -1: it lives",
                      "no cell dies by it.",
                      true})
    , when(setting.state.use(parameters.when))
    , shrinking_time(setting.state.use(parameters.shrinking_time))
    , final_volume(setting.state.use(parameters.final_volume))
    , keep_debris(setting.state.use(parameters.keep_debris))
    , has_condition(!when.is_always(0.))
    , slack(setting.slack)
  {
    // What is fixed at the moment of death is stored with the cell, as the
    // expressions go on changing.
    CellColumns<dim> &columns = setting.columns;
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
  Death<dim>::kill(const PresentCell<dim>      &cell,
                   const CellView<dim, double> &row,
                   const double                 t) const
  {
    // The times and volumes of the shrinking are those of the moment of death,
    // and so is the decision whether the cell stays.
    this->end(row, t);
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
      whole > 0. ? std::clamp((t - this->time_of_death(row)) / whole, 0., 1.) :
                   1.;
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
             this->time_of_death(cell) + cell.get(duration) :
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
  void
  Death<dim>::declare(Tables<dim> &tables) const
  {
    tables.add_sum("dying", [this](const PresentCell<dim> &cell) {
      return is_dead(cell.cell()) ? 1. : 0.;
    });
    EndAtRate<dim>::declare(tables);
  }


  template <int dim>
  void
  Death<dim>::check_cell(const PresentCell<dim> &founder, const double) const
  {
    for (const Expression *expression : {this->rates(0)[0],
                                         &when,
                                         &shrinking_time,
                                         &final_volume,
                                         &keep_debris})
      founder.value(*expression, 0.);
  }


  template <int dim>
  void
  Death<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    EndAtRate<dim>::review(scene, review);
    if (has_condition && never_acts<dim>(
                           when,
                           [](const double value) { return value > 0.; },
                           AskedAt::ends_of_steps,
                           scene))
      review.warn(when.key(),
                  when.text(),
                  "it holds for no founder at the beginning or end of any "
                  "step: no cell dies by it.",
                  "Correct it, or remove it.");
  }


  template class Death<2>;
  template class Death<3>;
} // namespace Morula
