// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A fate: a second way to die, with a column, an event and a count of its own.

#ifndef own_effects_anoikis_h
#define own_effects_anoikis_h

#include <morula/effects/fate/fate.h>
#include <morula/effects/tables.h>

#include <limits>

namespace Own
{
  using namespace Morula;

  struct AnoikisKeys : public EffectKeys
  {
    ExpressionKey where{{this, "Where"},
                        "",
                        "Cells that lose their hold; empty: none.",
                        Evaluated::step};
    Key<double>   after{{this, "After"},
                      0.,
                      "Time of death, where the cell stands then. "
                        "Units: day."};

    bool
    is_on() const override
    {
      return !where.empty();
    }

    EffectFacts
    facts() const override
    {
      return {&where};
    }
  };

  template <int dim>
  class Anoikis : public Fate<dim>, public Dies<dim>
  {
  public:
    using Parameters = AnoikisKeys;

    static constexpr EventKind event{"anoikis", 1};

    Anoikis(const Parameters &parameters, const EffectSetting<dim> &setting)
      : where(setting.state.use(parameters.where))
      , after(parameters.after)
      , lost_time(setting.columns.template add<double>(
          {"lost_time", "day", "when the cell was lost; -1: it lives", -1.}))
    {}

    void
    declare(Tables<dim> &tables) const override
    {
      tables.record_events(true);
      tables.add_count("lost", event);
    }

    std::optional<double>
    next(const PresentCell<dim> &cell,
         const CellView<dim, double> &,
         const Stretch &stretch) const override
    {
      const bool is_due = after > stretch.begin && after <= stretch.end;
      return is_due && cell.value(where, after) > 0. ?
               std::optional<double>(after) :
               std::nullopt;
    }

    LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch &,
           const double            s,
           std::vector<CellEvent> &events) const override
    {
      row.set(lost_time, s);
      events.push_back(
        {s, cell.id(), event, cell.type(), cell.type(), "no hold"});
      return LifeAfter::ends;
    }

    double
    time_of_death(const CellView<dim, const double> &cell) const override
    {
      return cell.get(lost_time) < 0. ?
               std::numeric_limits<double>::infinity() :
               cell.get(lost_time);
    }

  private:
    const Expression     where;
    const double         after;
    const Column<double> lost_time;
  };
} // namespace Own

#endif
