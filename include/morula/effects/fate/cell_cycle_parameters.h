// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_cell_cycle_parameters_h
#define morula_effects_fate_cell_cycle_parameters_h

#include <morula/base/key.h>
#include <morula/effects/effect.h>

#include <string>
#include <vector>

namespace Morula
{
  /** Section "Proliferation/Cell cycle", but for DivisionParameters. */
  struct CellCycleParameters : public EffectKeys
  {
    /** of all types that have none of their own */
    static inline const std::string of_founder =
      " An expression of X, Y, Z (um), evaluated at the founder's initial "
      "position and inherited by all its descendants.";

    Key<std::string> law{{this, "Proliferation/Law"},
                         "none",
                         "How cells grow and divide.",
                         {"none|cell cycle"}};

    Key<std::string> start{
      {this, "Proliferation/Cell cycle/Start"},
      "waiting",
      "State at t = 0: 'waiting': all cells in G0, with "
      "exponentially distributed waits; 'together': all cells "
      "enter S at t = 0.",
      {"waiting|together"}};

    ExpressionKey duration{{this, "Proliferation/Cell cycle/Duration"},
                           "1",
                           "T_cycle: total duration of S, G2, M and G1. "
                           "Positive, and at least twice Time/Step." +
                             of_founder + " Units: day.",
                           Evaluated::event,
                           positive("day",
                                    "Choose the duration of a cycle in days.")};

    ExpressionKey exit_rate{
      {this, "Proliferation/Cell cycle/G0 exit rate"},
      "1",
      "Lambda: rate of the exponentially distributed "
      "wait in G0. Not negative; 0: cells never leave G0." +
        of_founder + " Units: 1/day.",
      Evaluated::event,
      not_negative("1/day", "0 lets cells wait forever.")};

    /** J_th */
    ExpressionKey size_checkpoint{
      {this, "Proliferation/Cell cycle/Size checkpoint"},
      "0",
      "J_th: a cell enters S only while its elastic volume "
      "ratio J_e is above this value. Not negative; 0: no "
      "checkpoint." +
        of_founder,
      Evaluated::event,
      not_negative("(a ratio of volumes)", "0 means no checkpoint.")};

    ExpressionKey where{{this, "Proliferation/Cell cycle/Where"},
                        "1",
                        "Founders for which this is > 0 proliferate." +
                          of_founder,
                        Evaluated::founder};

    bool
    is_on() const override;

    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.switch_key    = &law;
      facts.divides_cells = true;
      facts.grows_cells   = true;
      facts.founders_key  = &where;
      facts.topic         = "proliferation";
      return facts;
    }

    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &of_cells) override;

    std::string
    details() const override;

  private:
    bool is_law_of_types = false; // of some
  };
} // namespace Morula

#endif
