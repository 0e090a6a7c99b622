// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/fate/end_at_rate.h>
#include <morula/effects/fate/random.h>

namespace Morula
{
  namespace
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

      EffectFacts
      facts() const override
      {
        return {&rate};
      }

      bool
      loses_cells() const override
      {
        return true;
      }
    };

    /**
     * How live cells leave the tissue: at a rate (1/day), a hazard with a
     * threshold of its own. The cell is whole until the end of the step of its
     * event and then goes with its grown volume; the cells of its grid cell
     * take over all the space that it had, so that their pressure falls and the
     * tissue closes up: doc/theory.md, section 6.9.
     */
    template <int dim>
    class Extrusion : public EndAtRate<dim>
    {
    public:
      using Parameters = ExtrusionParameters;

      Extrusion(const Parameters &parameters, const EffectSetting<dim> &setting)
        : EndAtRate<dim>(
            parameters.rate,
            setting,
            [](const std::uint64_t seed, const std::uint64_t key) {
              return Random::threshold_of("extrusion", seed, key);
            },
            "extrusion",
            "when the cell leaves; -1: not yet",
            false)
      {}

      LifeAfter
      happen(const PresentCell<dim>      &cell,
             const CellView<dim, double> &row,
             const Stretch &,
             const double            s,
             std::vector<CellEvent> &events) const override
      {
        this->end(cell, row, s, events, "extruded");
        return LifeAfter::ends;
      }

      bool
      shrinks(const CellView<dim, const double> &cell) const override
      {
        // Nothing shrinks, but the space is handed on as that of a shrunken
        // cell.
        return this->has_ended(cell);
      }
    };
  } // namespace


  void
  add_extrusion(Catalogue &catalogue)
  {
    catalogue.add_own<Extrusion>("extrusion", {"Extrusion/Rate=1"});
  }
} // namespace Morula
