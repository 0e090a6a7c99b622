// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/divides_at_once.h>
#include <morula/effects/scene_keys.h>

namespace Morula
{
  namespace
  {
    /** Section "Division". */
    struct DivisionAtRateParameters : public EffectKeys
    {
      ExpressionKey rate{
        {this, "Division/Rate"},
        "0",
        "Rate at which cells divide into two halves, without a cell cycle: an "
        "expression of their state, e.g. 2*ramp(volume, 500, 1000); not "
        "negative. Cells grow by Growth/Law. The keys of Proliferation/Cell "
        "cycle about axes and daughters apply; Division axis is 'cell shape' "
        "unless it is set. Units: 1/day.",
        Evaluated::step,
        not_negative("1/day", "0 lets no cell divide.")};

      EffectFacts
      facts() const override
      {
        EffectFacts facts;
        facts.switch_key    = &rate;
        facts.divides_cells = true;
        return facts;
      }
    };


    /** Cells divide at a rate, a hazard with a threshold of its own:
     *  doc/theory.md, section 6.10. */
    template <int dim>
    class DivisionAtRate : public DividesAtOnce<dim>
    {
    public:
      using Parameters = DivisionAtRateParameters;

      DivisionAtRate(const Parameters         &parameters,
                     const EffectSetting<dim> &setting)
        : DividesAtOnce<dim>(setting)
      {
        // A rate that does not follow the state misses nothing.
        const Expression rate = setting.state.use(parameters.rate);
        const auto add = [&columns = setting.columns](const auto &...column) {
          return columns.template add<double>({column..., AtDivision::reset});
        };
        const Column<double> integral =
          add("division_hazard", "", "rate of division, integrated", 0.);
        const Column<double> expected =
          rate.follows_state() ?
            add("division_rate",
                "1/day",
                "rate of division that the last step saw; -1: none",
                not_expected) :
            Column<double>();
        this->hazards_of_types[0].push_back(
          {rate,
           integral,
           expected,
           [seed = setting.random_seed](const PresentCell<dim> &cell,
                                        const CellView<dim, const double> &) {
             return Random::threshold_of("division", seed, cell.lineage_key());
           }});
        this->declare_event(setting.columns);
      }
    };
  } // namespace


  void
  add_division_at_rate(Catalogue &catalogue)
  {
    catalogue.add_own<DivisionAtRate>(
      "division at a rate",
      {"Division/Rate=2*J_e + 0.1*X*Y",
       "Growth/Law=rate",
       "Growth/Rate/Rate=1",
       "Proliferation/Cell cycle/Division axis=random",
       "Proliferation/Cell cycle/Least anisotropy=1"});
  }
} // namespace Morula
