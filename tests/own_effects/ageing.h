// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A fate: cells know the time since they were born.

#ifndef own_effects_ageing_h
#define own_effects_ageing_h

#include <morula/effects/fate/fate.h>

namespace Own
{
  using namespace Morula;

  struct AgeingKeys : public EffectKeys
  {
    Key<bool> record{"Record", false, "Whether cells have an age."};

    bool
    is_on() const override
    {
      return record;
    }

    using Keys::list;
    KeyList
    list() override
    {
      return {&record};
    }
  };

  template <int dim>
  class Ageing : public Fate<dim>
  {
  public:
    using Parameters = AgeingKeys;

    Ageing(const Parameters &, const EffectSetting<dim> &setting)
      : age(setting.columns.template add<double>(
          {"age", "day", "time since birth", 0., AtDivision::reset, true}))
      , dose(setting.columns.template find<double>("dose"))
      , earlier_dose(setting.columns.template add<double>(
          {"earlier_dose",
           "",
           "dose at the beginning of the last step",
           0.,
           AtDivision::copied,
           true}))
    {}

    void
    advance(const CellView<dim, const double> &before,
            const CellView<dim, double>       &after,
            const double                       t0,
            const double                       t1) const override
    {
      after.set(age, before.get(age) + t1 - t0);
      // That of t0, although the law has written the one of t1 already.
      after.set(earlier_dose, before.get(dose));
    }

  private:
    const Column<double> age, dose, earlier_dose;
  };
} // namespace Own

#endif
