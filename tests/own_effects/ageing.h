// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A trait: cells know the time since they were born.

#ifndef own_effects_ageing_h
#define own_effects_ageing_h

#include <morula/effects/step_effect.h>

namespace Own
{
  using namespace Morula;

  struct AgeingKeys : public EffectKeys
  {
    Key<bool>     record{{this, "Record"}, false, "Whether cells have an age."};
    ExpressionKey pace{{this, "Pace"},
                       "1",
                       "Of growing old: an expression of the cell's state.",
                       Evaluated::step};
    ExpressionKey first{{this, "First"},
                        "0",
                        "A number of a founder: an expression of its state.",
                        Evaluated::step};

    bool
    is_on() const override
    {
      return record;
    }

    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.numbers = {"earlier_dose"};
      return facts;
    }
  };

  template <int dim>
  class Ageing : public Trait<dim>
  {
  public:
    using Parameters = AgeingKeys;

    Ageing(const Parameters &parameters, const EffectSetting<dim> &setting)
      : pace(setting.state.use(parameters.pace))
      , first(setting.state.use(parameters.first))
      , age(setting.columns.template add<double>(
          {"age", "day", "time since birth", 0., AtDivision::reset, true}))
      , dose(setting.columns.template find<double>("dose"))
      , earlier_dose(setting.columns.template add<double>(
          {"earlier_dose",
           "",
           "dose at the beginning of the last step",
           0.,
           AtDivision::copied,
           true}))
      , at_first(setting.columns.template add<double>(
          {"at_first", "", "of the founder", 0., AtDivision::copied, true}))
    {}

    void
    begin(const PresentCell<dim>      &founder,
          const CellView<dim, double> &row) const override
    {
      row.set(at_first, founder.value(first, 0.));
    }

    void
    check_cell(const PresentCell<dim> &founder, const double) const override
    {
      founder.value(pace, 0.);
    }

    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override
    {
      after.set(age,
                before.cell().get(age) + before.value(pace, t0) * (t1 - t0));
      // That of t0, although the law has written the one of t1 already.
      after.set(earlier_dose, before.cell().get(dose));
    }

  private:
    const Expression     pace, first;
    const Column<double> age, dose, earlier_dose, at_first;
  };
} // namespace Own

#endif
