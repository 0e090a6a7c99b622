// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_extrusion_h
#define morula_effects_fate_extrusion_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/end_at_rate.h>
#include <morula/effects/fate/random.h>

namespace Morula
{
  /** Section "Extrusion". */
  struct ExtrusionParameters : public EffectKeys
  {
    ExpressionKey rate{
      {this, "Extrusion/Rate"},
      "0",
      "Rate at which live cells leave the tissue with their volume, which "
      "closes up behind them: an expression of their state, e.g. "
      "5*ramp(pressure, 0.2, 0.5)*(present_depth < 10); not negative. "
      "Units: 1/day.",
      Evaluated::step,
      not_negative("1/day", "0 keeps cells in.")};

    bool
    is_on() const override
    {
      return !rate.expression(3).is_always(0.);
    }

    EffectFacts
    facts() const override
    {
      return {&rate};
    }

    std::string
    details() const override
    {
      return "rate = " + rate.text() + " /day";
    }
  };

  /**
   * How live cells leave the tissue: at a rate (1/day), a hazard with a
   * threshold of its own. The cell is whole until the end of the step of its
   * event and then goes with its grown volume; the cells of its grid cell take
   * over all the space that it had, so that their pressure falls and the tissue
   * closes up: doc/theory.md, section 6.9.
   */
  template <int dim>
  class Extrusion : public EndAtRate<dim>
  {
  public:
    using Parameters = ExtrusionParameters;

    /** Declares the columns. @throws InputError */
    Extrusion(const Parameters &parameters, const EffectSetting<dim> &setting);

    LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s,
           std::vector<CellEvent>      &events) const override;

    double
    removal_time(const CellView<dim, const double> &cell) const override;

    bool
    shrinks(const CellView<dim, const double> &cell) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

  private:
    double
    threshold(const std::uint64_t seed, const std::uint64_t key) const override
    {
      return Random::threshold_of("extrusion", seed, key);
    }
  };
} // namespace Morula

#endif
